# Everything talus stands on; all are Debian 12 packages (the list is in tools/setup.sh).
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt 9 REQUIRED)
find_package(tomlplusplus 3.3 REQUIRED)
find_package(GEOS 3.11 REQUIRED)
pkg_check_modules(muparser REQUIRED IMPORTED_TARGET muparser)
pkg_check_modules(cairo REQUIRED IMPORTED_TARGET cairo)
find_package(nlohmann_json 3.11 REQUIRED)
