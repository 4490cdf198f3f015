install(TARGETS talus ARCHIVE)
