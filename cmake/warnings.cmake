# Warnings are errors in every build of talus itself, never in a build that uses talus.
add_library(talus_warnings INTERFACE)
target_compile_options(
  talus_warnings
  INTERFACE $<BUILD_INTERFACE:-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor
            -Woverloaded-virtual>)
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(talus_warnings INTERFACE $<BUILD_INTERFACE:-Werror>)
endif()
