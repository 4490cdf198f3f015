# What Debian wants of the files of packages, before cpack closes them: copyright, changelogs, overrides of lintian, compressed
# pages, no search paths in the files themselves. Run by cpack (cmake/packages.cmake).

function(compress file)
  execute_process(COMMAND gzip -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# of the last commit where SOURCE_DATE_EPOCH says so (tools/packages.sh), so that the same sources make the same packages
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(READ ${CPACK_TALUS_PACKAGES}/copyright/talus part_talus)
file(READ ${CPACK_TALUS_PACKAGES}/copyright/program part_program)
file(READ ${CPACK_TALUS_PACKAGES}/copyright/pybind11 part_pybind11)

file(GLOB packages LIST_DIRECTORIES true ${CPACK_TEMPORARY_DIRECTORY}/*)
foreach(root ${packages})
  cmake_path(GET root FILENAME name)
  set(docs ${root}/usr/share/doc/${name})
  set(copyright "${part_talus}")
  if(name STREQUAL "talus")
    string(APPEND copyright "${part_program}")
    # the page of the report holds the notices of what is bundled in it
    file(READ ${root}/usr/share/talus/report_page.html page)
    string(REGEX MATCH "id=\"talus-notices\">([^<]*)<" notices "${page}")
    string(REGEX MATCHALL "Copyright \\(c\\) [^\n]*" lines "${CMAKE_MATCH_1}")
    foreach(line ${lines})
      string(REGEX REPLACE "Copyright \\(c\\) ([0-9-]+),? (.*)" "\\1 \\2" holder "${line}")
      string(FIND "${copyright}" "${holder}" at)
      if(at EQUAL -1)
        message(FATAL_ERROR "the page of the report holds software of ${holder}: name it in cmake/packages/copyright/program")
      endif()
    endforeach()
    if(NOT lines)
      message(FATAL_ERROR "the page of the report holds no notices of what is bundled in it (web/inline.mjs)")
    endif()
    file(COPY_FILE ${CPACK_TALUS_CHANGES} ${docs}/changelog)
    compress(${docs}/changelog)
    compress(${root}/usr/share/man/man1/talus.1)
  elseif(name STREQUAL "talus-maps")
    string(REPLACE "\n\nFiles: *" "\nComment: linked to GDAL, which Debian builds with parts under the GPL (poppler).\n\nFiles: *"
           copyright "${copyright}")
  elseif(name STREQUAL "python3-talus")
    string(APPEND copyright "${part_pybind11}")
    # the library lies where the linker looks
    file(GLOB modules ${root}/usr/lib/python3/dist-packages/talus/*.so)
    foreach(module ${modules})
      file(RPATH_REMOVE FILE ${module})
    endforeach()
  endif()
  file(WRITE ${docs}/copyright "${copyright}")
  file(WRITE ${docs}/changelog.Debian "talus (${CPACK_TALUS_VERSION}) bookworm; urgency=medium

  * What changed is in CHANGELOG.md, /usr/share/doc/talus/changelog.gz.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
  compress(${docs}/changelog.Debian)
  if(EXISTS ${CPACK_TALUS_PACKAGES}/${name}/lintian-overrides)
    file(MAKE_DIRECTORY ${root}/usr/share/lintian/overrides)
    file(COPY_FILE ${CPACK_TALUS_PACKAGES}/${name}/lintian-overrides ${root}/usr/share/lintian/overrides/${name})
  endif()
endforeach()
