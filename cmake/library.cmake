# The library for other programs: all rooms in one shared object, of which only the names in the
# namespace samara are seen; its headers, and what find_package(Samara) needs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

add_library(samara_library SHARED)
foreach(room ${SAMARA_ROOMS})
  get_target_property(kind samara_${room} TYPE)
  if(kind STREQUAL "STATIC_LIBRARY")
    target_sources(samara_library PRIVATE $<TARGET_OBJECTS:samara_${room}>)
  endif()
endforeach()
set_target_properties(
  samara_library
  PROPERTIES OUTPUT_NAME samara
             EXPORT_NAME samara
             LINKER_LANGUAGE CXX
             VERSION ${PROJECT_VERSION}
             SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
             LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exported_names.txt)
target_link_options(samara_library PRIVATE
                    -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/exported_names.txt
                    -Wl,--no-undefined)
target_compile_features(samara_library INTERFACE cxx_std_20)
target_include_directories(samara_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(
  samara_library
  PRIVATE samara_external_petsc samara_external_files PkgConfig::FFTW PkgConfig::MUPARSER
  INTERFACE Eigen3::Eigen PkgConfig::SLEPC PkgConfig::PETSC MPI::MPI_CXX)

# Components: the packages of cmake/packages.cmake. `cmake --install` installs all of them, and the Python
# package where the program finds it under any prefix.
set(samara_package ${CMAKE_INSTALL_LIBDIR}/cmake/Samara)
install(TARGETS samara samara_program samara_controller_host RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR}
        COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/inputs DESTINATION ${CMAKE_INSTALL_DATADIR}/samara
        COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/completions/samara
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/templates DESTINATION ${CMAKE_INSTALL_DATADIR}/samara
        COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/docs/samara.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
        COMPONENT program OPTIONAL)
install(TARGETS samara_library EXPORT SamaraTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/ ${PROJECT_BINARY_DIR}/include/
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/samara
        DESTINATION ${CMAKE_INSTALL_DATADIR}/samara/python COMPONENT python_of_prefix
        PATTERN "__pycache__" EXCLUDE)
install(EXPORT SamaraTargets NAMESPACE samara:: DESTINATION ${samara_package}
        COMPONENT development)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/SamaraConfig.cmake.in ${PROJECT_BINARY_DIR}/SamaraConfig.cmake
  INSTALL_DESTINATION ${samara_package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/SamaraConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/SamaraConfig.cmake
              ${PROJECT_BINARY_DIR}/SamaraConfigVersion.cmake
        DESTINATION ${samara_package} COMPONENT development)
