# Finds MUMPS in double precision, and the MPI that it was built with: neither has a CMake package or a .pc file of one name
# everywhere. Defines the target slender_mumps, and MUMPS_LIBRARIES: the files.
find_package(MPI COMPONENTS C)
find_path(MUMPS_INCLUDE_DIR dmumps_c.h PATH_SUFFIXES mumps MUMPS)
find_library(MUMPS_LIBRARY dmumps)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MUMPS REQUIRED_VARS MUMPS_LIBRARY MUMPS_INCLUDE_DIR MPI_C_FOUND)
if(MUMPS_FOUND)
    add_library(slender_mumps INTERFACE)
    set(MUMPS_LIBRARIES ${MUMPS_LIBRARY} ${MPI_C_LIBRARIES})
    target_include_directories(slender_mumps SYSTEM INTERFACE ${MUMPS_INCLUDE_DIR})
    target_link_libraries(slender_mumps INTERFACE ${MUMPS_LIBRARY} MPI::MPI_C)
endif()
