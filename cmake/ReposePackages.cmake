# Libraries, all from Debian 12: see docs/building.md for what each is for.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(TBB CONFIG REQUIRED)
find_package(hwy CONFIG REQUIRED)
find_package(jsoncpp CONFIG REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(muparser REQUIRED IMPORTED_TARGET muparser)
if(REPOSE_COMMAND)
  find_package(CLI11 CONFIG REQUIRED)
  find_package(PNG REQUIRED)
endif()
find_package(ZLIB REQUIRED)
find_package(Threads REQUIRED)

# Debian's FindOpenVDB sets BUILD_SHARED_LIBS in the scope that calls it.
set(repose_saved_shared "${BUILD_SHARED_LIBS}")
list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
find_package(OpenVDB 10 REQUIRED COMPONENTS openvdb)
set(BUILD_SHARED_LIBS "${repose_saved_shared}")

# OpenVDB behind one target. Its headers are system headers (their warnings are not ours), and OpenVDB 10
# does not compile with the C++20 constraints of oneTBB 2021.8 (OpenVDB issue 1719).
add_library(repose_openvdb INTERFACE)
target_link_libraries(repose_openvdb INTERFACE OpenVDB::openvdb)
target_compile_definitions(repose_openvdb INTERFACE __TBB_USE_CONSTRAINTS=0)
