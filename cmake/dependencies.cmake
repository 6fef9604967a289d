# The libraries Samara stands on, all as imported targets: their headers are SYSTEM headers.
find_package(PkgConfig REQUIRED)

set(MPI_CXX_SKIP_MPICXX ON)
find_package(MPI REQUIRED COMPONENTS C CXX)
pkg_check_modules(PETSC REQUIRED IMPORTED_TARGET petsc>=3.18)
pkg_check_modules(SLEPC REQUIRED IMPORTED_TARGET slepc>=3.18)
set(BLA_VENDOR Generic)  # Debian's alternative: OpenBLAS where it is installed
find_package(LAPACK REQUIRED)  # with BLAS
pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3>=3.3)
pkg_check_modules(MUPARSER REQUIRED IMPORTED_TARGET muparser>=2.3)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(yaml-cpp 0.7 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
# Not FindHDF5: it fails in a folder whose name has a space.
pkg_search_module(HDF5 REQUIRED IMPORTED_TARGET hdf5-openmpi>=1.10 hdf5-mpi>=1.10 hdf5>=1.10)
# Dimension scales are in its high-level part, whose name the pkg-config file does not give.
find_library(HDF5_HL NAMES hdf5_hl HINTS ${HDF5_LIBRARY_DIRS} REQUIRED)
if(SAMARA_TESTS)
  find_package(Boost 1.74 REQUIRED COMPONENTS unit_test_framework)
endif()

# Debian's pkg-config files carry Debian's own compile flags (-D_FORTIFY_SOURCE, -Wdate-time).
set_property(TARGET PkgConfig::PETSC PkgConfig::SLEPC PkgConfig::HDF5 PkgConfig::FFTW
             PkgConfig::MUPARSER
             PROPERTY INTERFACE_COMPILE_OPTIONS "")

add_library(samara_external_petsc INTERFACE)
target_link_libraries(samara_external_petsc
                      INTERFACE PkgConfig::SLEPC PkgConfig::PETSC MPI::MPI_CXX LAPACK::LAPACK)

# Libraries of the file formats: only the room io may use them.
add_library(samara_external_files INTERFACE)
target_include_directories(samara_external_files SYSTEM INTERFACE ${YAML_CPP_INCLUDE_DIR})
target_link_libraries(samara_external_files INTERFACE yaml-cpp nlohmann_json::nlohmann_json ${HDF5_HL} PkgConfig::HDF5 MPI::MPI_CXX)
