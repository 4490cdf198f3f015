# What cmake --install puts where: the shared library with talus.h and what it includes, and how other projects find them.
# The program, its models, pages and modules are installed where they are built (app, web, src/modules, tests).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# of the objects of the static one, which the program and the tests are linked to
file(WRITE ${PROJECT_BINARY_DIR}/empty.cpp "")
add_library(talus_shared SHARED ${PROJECT_BINARY_DIR}/empty.cpp)
set_target_properties(talus_shared PROPERTIES
  OUTPUT_NAME talus EXPORT_NAME talus VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_link_libraries(talus_shared PRIVATE "$<LINK_LIBRARY:WHOLE_ARCHIVE,talus>")
target_link_options(talus_shared PRIVATE -Wl,-Bsymbolic-functions)
target_include_directories(talus_shared INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(talus_shared INTERFACE cxx_std_20)

# Headers that talus.h includes, in turn; anything but the standard library would be one more thing for others to have.
function(talus_headers first out)
  set(todo ${first})
  set(found "")
  while(todo)
    list(POP_FRONT todo header)
    if(NOT header IN_LIST found)
      list(APPEND found ${header})
      file(STRINGS ${PROJECT_SOURCE_DIR}/src/${header} lines REGEX "^#include")
      foreach(line ${lines})
        if(line MATCHES "\"(talus/.+)\"")
          list(APPEND todo ${CMAKE_MATCH_1})
        elseif(line MATCHES "<(Eigen|fmt|nlohmann|toml|geos|cairo|H5|hdf5|zlib|muParser)")
          message(FATAL_ERROR "${header} is installed with talus.h, and includes ${CMAKE_MATCH_1}: ${line}")
        endif()
      endforeach()
    endif()
  endwhile()
  set(${out} ${found} PARENT_SCOPE)
endfunction()
talus_headers(talus/talus.h headers)

# The library, and what its users have, with libraries in `folder`. Once for an installation, and once more for packages
# (cmake/packages.cmake), where they lie by architecture: components of their own, that nothing else installs.
function(talus_install_library folder of)
  install(TARGETS talus_shared EXPORT ${of}talus_targets
          LIBRARY DESTINATION ${folder} COMPONENT ${of}library NAMELINK_COMPONENT ${of}development ${ARGN})
  foreach(header ${headers})
    cmake_path(GET header PARENT_PATH header_folder)
    install(FILES ${PROJECT_SOURCE_DIR}/src/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${header_folder}
            COMPONENT ${of}development ${ARGN})
  endforeach()
  set(config_folder ${folder}/cmake/talus)
  set(made ${PROJECT_BINARY_DIR}/${of}library)
  install(EXPORT ${of}talus_targets NAMESPACE talus:: FILE talusTargets.cmake DESTINATION ${config_folder}
          COMPONENT ${of}development ${ARGN})
  configure_package_config_file(cmake/talusConfig.cmake.in ${made}/talusConfig.cmake INSTALL_DESTINATION ${config_folder})
  write_basic_package_version_file(${made}/talusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${made}/talusConfig.cmake ${made}/talusConfigVersion.cmake DESTINATION ${config_folder}
          COMPONENT ${of}development ${ARGN})
  # by its own place, wherever cmake --install --prefix has put it
  file(RELATIVE_PATH to_prefix /${folder}/pkgconfig /)
  set(prefix "\${pcfiledir}/${to_prefix}")
  if(of)
    set(prefix /usr)  # a package is not moved, and pkg-config leaves out what compilers look at by themselves
  endif()
  set(library_folder ${folder})
  configure_file(cmake/talus.pc.in ${made}/talus.pc @ONLY)
  install(FILES ${made}/talus.pc DESTINATION ${folder}/pkgconfig COMPONENT ${of}development ${ARGN})
endfunction()
talus_install_library(${CMAKE_INSTALL_LIBDIR} "")

# what the program tells of itself
if(TARGET talus_app)
  set(pages ${PROJECT_BINARY_DIR}/share/pages)
  add_custom_command(
    OUTPUT ${pages}/talus.1 ${pages}/talus ${pages}/_talus ${pages}/talus.fish
    COMMAND ${CMAKE_COMMAND} -E make_directory ${pages}
    COMMAND talus_app man > ${pages}/talus.1
    COMMAND talus_app completion bash > ${pages}/talus
    COMMAND talus_app completion zsh > ${pages}/_talus
    COMMAND talus_app completion fish > ${pages}/talus.fish
    DEPENDS talus_app
    VERBATIM)
  add_custom_target(talus_pages ALL DEPENDS ${pages}/talus.1)
  install(FILES ${pages}/talus.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  install(FILES ${pages}/talus DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES ${pages}/_talus DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
  install(FILES ${pages}/talus.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
endif()
# what ./run.sh --install builds
add_custom_target(installation DEPENDS talus_shared)
foreach(part program talus_pages)
  if(TARGET ${part})
    add_dependencies(installation ${part})
  endif()
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/docs/licences.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
# packages have it in their file copyright
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)
