# Debian packages of the library's components, made by cpack (scripts/package):
#   samara          the program, its launcher, the helper program of controller libraries, inputs, templates, completion, manual page
#   libsamara-dev   the shared library, its headers, the package for CMake, the examples
#   python3-samara  the Python package, for Debian's own interpreter
# Only cpack installs the files that are marked EXCLUDE_FROM_ALL.
if(NOT TARGET samara_library)
  return()
endif()

set(SAMARA_MAINTAINER "The Samara developers <developers@samara.invalid>"
    CACHE STRING "Maintainer of the Debian packages, with an address")
mark_as_advanced(SAMARA_MAINTAINER)

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL program development python)
set(CPACK_PACKAGE_NAME samara)
set(CPACK_PACKAGE_CONTACT "${SAMARA_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # the first line of each description
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)  # dpkg-deb compresses them better at the end
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# dpkg-shlibdeps finds the packages of the shared libraries and their least versions.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS OFF)
# Packages of programs that use the library depend on libsamara-dev.
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME samara)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
# mpirun, a fast BLAS, pictures: the program runs without them.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS
    "openmpi-bin, libopenblas0-serial | libopenblas0, python3-samara (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
"rotor dynamics of horizontal-axis wind turbines
Samara computes the periodic steady state of a horizontal-axis wind turbine
and all its modes about that state, with their frequencies and damping, while
the rotor turns. It also simulates motions in time, counts the cycles of
their loads, and writes linear models for control design. It imports turbines
of OpenFAST, windIO and HAWC2.

This package has the program, example turbines in /usr/share/samara/inputs
and the cases of 'samara new'. Pictures need python3-samara.")

# The headers include those of the PETSc and SLEPc that the library was built with; petsc.pc and
# slepc.pc, which its CMake package reads, are in the same packages.
foreach(library PETSC SLEPC)
  string(REGEX MATCH "^[0-9]+[.][0-9]+" samara_${library}_series "${${library}_VERSION}")
endforeach()
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsamara-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
string(CONCAT CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
       "libeigen3-dev (>= 3.4), libopenmpi-dev, libpetsc-real${samara_PETSC_series}-dev, "
       "libslepc-real${samara_SLEPC_series}-dev, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake (>= 3.25), g++")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "samara (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
"rotor dynamics of wind turbines: C++ library
Samara computes the periodic steady state of a horizontal-axis wind turbine
and all its modes about that state, while the rotor turns.

This package has the shared library of all its analyses, the headers for
C++20, the package Samara of CMake, and five example programs.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-samara)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
string(CONCAT CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
       "python3:any (>= 3.11), python3-h5netcdf, python3-h5py, python3-jsonschema, "
       "python3-matplotlib, python3-numpy, python3-xarray, python3-yaml")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "samara (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_PYTHON_DESCRIPTION
"rotor dynamics of wind turbines: Python package
Samara computes the periodic steady state of a horizontal-axis wind turbine
and all its modes about that state, while the rotor turns.

This package reads its results as labelled arrays, runs the program, changes
its cases, and draws the pictures of 'samara plot'.")

install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/samara DESTINATION lib/python3/dist-packages
        COMPONENT python EXCLUDE_FROM_ALL PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/cpp
        DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libsamara-dev/examples
        COMPONENT development EXCLUDE_FROM_ALL)

# Bytecode comes and goes with the package, as Debian's own Python packages do it.
set(samara_scripts ${PROJECT_BINARY_DIR}/package_scripts)
file(CONFIGURE OUTPUT ${samara_scripts}/postinst @ONLY CONTENT [[
#!/bin/sh
set -e
if [ "$1" = configure ] && command -v py3compile >/dev/null; then
  py3compile -p python3-samara
fi
]])
file(CONFIGURE OUTPUT ${samara_scripts}/prerm @ONLY CONTENT [[
#!/bin/sh
set -e
if command -v py3clean >/dev/null; then
  py3clean -p python3-samara
fi
]])
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${samara_scripts}/postinst ${samara_scripts}/prerm)

# cpack 3.25 adds the file of a link to Installed-Size, and calls ldconfig in scripts where Debian has a
# trigger. Both are corrected, and dpkg-deb makes the package again.
file(WRITE ${samara_scripts}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_CONTROL_EXTRA ${samara_scripts}/triggers)
file(CONFIGURE OUTPUT ${samara_scripts}/finish.cmake @ONLY CONTENT [[
foreach(package ${CPACK_PACKAGE_FILES})
  set(tree ${package}.tree)
  execute_process(COMMAND dpkg-deb -R ${package} ${tree} COMMAND_ERROR_IS_FATAL ANY)
  if(EXISTS ${tree}/DEBIAN/triggers)
    file(REMOVE ${tree}/DEBIAN/postinst ${tree}/DEBIAN/postrm)
  endif()
  set(size 0)  # as dpkg-gencontrol counts: in KiB, 1 for what is no file
  file(GLOB_RECURSE entries LIST_DIRECTORIES true ${tree}/usr/*)
  foreach(entry ${entries})
    set(bytes 1)
    if(NOT IS_SYMLINK ${entry} AND NOT IS_DIRECTORY ${entry})
      file(SIZE ${entry} bytes)
    endif()
    math(EXPR size "${size} + (${bytes} + 1023) / 1024")
  endforeach()
  file(READ ${tree}/DEBIAN/control control)
  string(REGEX REPLACE "Installed-Size: [0-9]+" "Installed-Size: ${size}" control "${control}")
  file(WRITE ${tree}/DEBIAN/control "${control}")
  execute_process(COMMAND dpkg-deb --root-owner-group -Zxz -b ${tree} ${package}
                  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE_RECURSE ${tree})
endforeach()
]])
set(CPACK_POST_BUILD_SCRIPTS ${samara_scripts}/finish.cmake)

# What Debian's policy asks of each package: the licences, and a changelog in its own form, with the
# date of CHANGELOG.md. The Python package has parts of others, which report/licences names.
file(GLOB samara_licences CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/report/licences/*.txt)
foreach(component ${CPACK_COMPONENTS_ALL})
  set(text "")
  set(licences ${PROJECT_SOURCE_DIR}/LICENSE)
  if(component STREQUAL python)
    list(APPEND licences ${samara_licences})
  endif()
  foreach(licence ${licences})
    file(READ ${licence} part)
    string(APPEND text "${part}\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${licence})
  endforeach()
  file(WRITE ${samara_scripts}/${component}/copyright "${text}")
endforeach()
file(TIMESTAMP ${PROJECT_SOURCE_DIR}/CHANGELOG.md samara_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(CONFIGURE OUTPUT ${samara_scripts}/changelog @ONLY CONTENT
"samara (@PROJECT_VERSION@) unstable; urgency=medium

  * Version @PROJECT_VERSION@.

 -- @SAMARA_MAINTAINER@  @samara_date@
")
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} name)
  set(folder ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${name}_PACKAGE_NAME})
  install(FILES ${samara_scripts}/${component}/copyright ${samara_scripts}/changelog
          DESTINATION ${folder} COMPONENT ${component} EXCLUDE_FROM_ALL)
  set(compressed ${folder}/changelog)
  if(component STREQUAL program)
    list(APPEND compressed ${CMAKE_INSTALL_MANDIR}/man1/samara.1)
  endif()
  install(CODE "
    foreach(file ${compressed})
      set(file \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/\${file}\")
      if(EXISTS \"\${file}\")
        execute_process(COMMAND gzip -9nf \"\${file}\" COMMAND_ERROR_IS_FATAL ANY)
      endif()
    endforeach()" COMPONENT ${component} EXCLUDE_FROM_ALL)
endforeach()

include(CPack)
