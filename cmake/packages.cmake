# Debian packages of what is built (docs/packages.md): talus, libtalus-dev, talus-maps, python3-talus. cpack makes them in the
# build folder; tools/packages.sh builds first and looks over them. Their files are those of an installation under /usr, but
# for libraries, which Debian keeps by architecture.
if(NOT CMAKE_LIBRARY_ARCHITECTURE)
  return()
endif()
talus_install_library(lib/${CMAKE_LIBRARY_ARCHITECTURE} package_ EXCLUDE_FROM_ALL)

set(TALUS_MAINTAINER "the talus authors <authors@talus.invalid>" CACHE STRING
    "Name and address in the packages: of whoever gives them to others")
set(package_revision 1)
set(package_version ${PROJECT_VERSION}-${package_revision})

set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_NAME talus)
set(CPACK_PACKAGE_CONTACT ${TALUS_MAINTAINER})
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
# whatever the umask of who builds
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${package_revision})
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
# what dpkg knows of the libraries that are linked to; ours it finds in the build folder
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/packages/finish.cmake)
set(CPACK_TALUS_PACKAGES ${PROJECT_SOURCE_DIR}/cmake/packages)
set(CPACK_TALUS_VERSION ${package_version})
set(CPACK_TALUS_CHANGES ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
set(CPACK_COMPONENTS_ALL "")

# A package of some components, the words after its text. Scripts and triggers lie in cmake/packages/NAME; what else Debian wants
# is written by finish.cmake there.
macro(talus_package name section depends synopsis text)
  list(APPEND CPACK_COMPONENTS_ALL ${ARGN})
  foreach(component ${ARGN})
    string(TOUPPER ${component} component)
    set(CPACK_COMPONENT_${component}_GROUP ${name})
  endforeach()
  string(TOUPPER ${name} package)
  set(CPACK_DEBIAN_${package}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${package}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${package}_PACKAGE_DEPENDS "${depends}")
  set(CPACK_DEBIAN_${package}_DESCRIPTION "dynamic analysis of jointed rock and masonry blocks${synopsis}\n${text}")
  foreach(script triggers postinst prerm)
    if(EXISTS ${PROJECT_SOURCE_DIR}/cmake/packages/${name}/${script})
      list(APPEND CPACK_DEBIAN_${package}_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/packages/${name}/${script})
    endif()
  endforeach()
endmacro()

talus_package(talus science "" "" "talus computes how systems of blocks - jointed rock, masonry - move, slip and
break under dynamic load, by explicit discontinuous deformation analysis
(DDA). It finds the contact forces themselves, from the contact equations. A
model is a text file; results are tables, files for ParaView and a report of
one HTML page.

This package holds the program, its library, models to begin from, examples
and the cases that verify it (talus verify)." program package_library)
# who links to the library depends on this package
file(WRITE ${PROJECT_BINARY_DIR}/packages/shlibs
     "libtalus ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} talus (>= ${PROJECT_VERSION})\n")
list(APPEND CPACK_DEBIAN_TALUS_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/packages/shlibs)
set(CPACK_DEBIAN_TALUS_PACKAGE_SUGGESTS "talus-maps, xdg-utils")

talus_package(libtalus-dev libdevel "talus (= ${package_version})" " - headers" "talus computes how systems of blocks - jointed rock, masonry - move, slip and
break under dynamic load.

This package holds what C++ programs need that stand on its library: headers,
and what CMake and pkg-config find it by." package_development)

if(TARGET talus_vector)
  talus_package(talus-maps science "talus (= ${package_version})" " - maps" "talus computes how systems of blocks - jointed rock, masonry - move, slip and
break under dynamic load.

This package holds the module by which 'talus cut' and 'talus import' read
maps and drawings: DXF, shapefile, GeoPackage and GeoJSON. It is linked to
GDAL, which talus itself is not." maps)
endif()

if(TARGET talus_python)
  # an extension is for the Python that it was built with
  get_directory_property(python_major DIRECTORY python DEFINITION Python_VERSION_MAJOR)
  get_directory_property(python_minor DIRECTORY python DEFINITION Python_VERSION_MINOR)
  math(EXPR python_next "${python_minor} + 1")
  talus_package(python3-talus python "talus (= ${package_version}), python3 (>= ${python_major}.${python_minor}), python3 (<< ${python_major}.${python_next}), python3-numpy"
                " - Python" "talus computes how systems of blocks - jointed rock, masonry - move, slip and
break under dynamic load.

This package holds the module talus for Python: models, runs, observers and
results as NumPy arrays." python)
  set(CPACK_DEBIAN_PYTHON3-TALUS_PACKAGE_SUGGESTS python3-matplotlib)
endif()

include(CPack)
