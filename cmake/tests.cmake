# One executable per folder of tests, one entry of ctest per source of it. Labels: unit, verification,
# program, tree.
#   tests/<room>/<name>_test.cpp + main.cpp          -> test_<room>.<name> (main.cpp: the module)
#   tests/<room>/<name>_mpi_test.cpp + mpi_main.cpp  -> test_<room>_mpi.<name>.<ranks>, 1, 2 and 3
#   tests/verification/                              -> test_verification.<name>, the same way
#   tests/drivers/*.sh, *.py                    -> the program as its users run it
#   tests/layering/                             -> rules of the source tree
#   tests/fuzz/<name>_harness.cpp               -> fuzz_<name>, a little of scripts/fuzz
#   tests/controllers/<name>.c                  -> libraries of controllers for tests/drivers
#   tests/dump/                                 -> dump_system, for scripts/compare_trees
set(samara_launcher ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/samara)

# Debian's own interpreter, which has h5py and numpy, whatever else is first in PATH.
set(SAMARA_PYTHON /usr/bin/python3 CACHE FILEPATH "Python with h5py, numpy and scipy")

set(samara_test_environment
    SAMARA_SOURCE_DIR=${PROJECT_SOURCE_DIR}
    SAMARA_PROGRAM=${samara_launcher}
    SAMARA_MPIEXEC=${MPIEXEC_EXECUTABLE}
    SAMARA_PYTHON=${SAMARA_PYTHON}
    SAMARA_CONTROLLERS=${PROJECT_BINARY_DIR}/tests/controllers
    OMP_NUM_THREADS=1
    OPENBLAS_NUM_THREADS=1
    OMPI_ALLOW_RUN_AS_ROOT=1
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
    OMPI_MCA_rmaps_base_oversubscribe=1
    OMPI_MCA_hwloc_base_binding_policy=none
    PYTHONDONTWRITEBYTECODE=1)

function(samara_add_boost_test target libraries)
  add_executable(${target} ${ARGN})
  target_link_libraries(${target} PRIVATE ${libraries} Boost::unit_test_framework)
  target_compile_definitions(
    ${target} PRIVATE BOOST_TEST_DYN_LINK SAMARA_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                      SAMARA_PROGRAM="${samara_launcher}")
endfunction()

function(samara_add_ctest name label)
  add_test(NAME ${name} COMMAND ${ARGN} WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  set_tests_properties(${name} PROPERTIES LABELS ${label}
                                          ENVIRONMENT "${samara_test_environment}" TIMEOUT 5000)
endfunction()

# Boost's names of the outermost suites and cases of a source, separated by commas.
function(samara_list_boost_tests source names)
  file(STRINGS ${source} lines REGEX "^BOOST_AUTO_TEST_(SUITE|CASE|SUITE_END) *[(]")
  set(found "")
  set(depth 0)
  foreach(line ${lines})
    if(line MATCHES "^BOOST_AUTO_TEST_SUITE_END")
      math(EXPR depth "${depth} - 1")
      continue()
    endif()
    if(depth EQUAL 0 AND line MATCHES "[(]([A-Za-z0-9_]+)")
      list(APPEND found ${CMAKE_MATCH_1})
    endif()
    if(line MATCHES "^BOOST_AUTO_TEST_SUITE")
      math(EXPR depth "${depth} + 1")
    endif()
  endforeach()
  list(JOIN found "," found)
  set(${names} ${found} PARENT_SCOPE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
endfunction()

function(samara_add_tests folder label libraries)
  set(directory ${PROJECT_SOURCE_DIR}/tests/${folder})
  file(GLOB serial CONFIGURE_DEPENDS ${directory}/*_test.cpp)
  file(GLOB parallel CONFIGURE_DEPENDS ${directory}/*_mpi_test.cpp)
  file(GLOB main CONFIGURE_DEPENDS ${directory}/main.cpp)
  file(GLOB mpi_main CONFIGURE_DEPENDS ${directory}/mpi_main.cpp)
  list(REMOVE_ITEM serial ${parallel})
  if(serial)
    samara_add_boost_test(test_${folder} "${libraries}" ${serial} ${main})
    foreach(source ${serial})
      get_filename_component(name ${source} NAME_WE)
      string(REGEX REPLACE "_test$" "" name ${name})
      samara_list_boost_tests(${source} tests)
      samara_add_ctest(test_${folder}.${name} ${label} test_${folder} --run_test=${tests})
    endforeach()
  endif()
  if(parallel)
    samara_add_boost_test(test_${folder}_mpi "${libraries}" ${parallel} ${mpi_main})
    foreach(source ${parallel})
      get_filename_component(name ${source} NAME_WE)
      string(REGEX REPLACE "_mpi_test$" "" name ${name})
      samara_list_boost_tests(${source} tests)
      foreach(ranks 1 2 3)
        set(entry test_${folder}_mpi.${name}.${ranks})
        samara_add_ctest(${entry} ${label} ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${ranks}
                         $<TARGET_FILE:test_${folder}_mpi> --run_test=${tests})
        set_tests_properties(${entry} PROPERTIES PROCESSORS ${ranks})
      endforeach()
    endforeach()
  endif()
endfunction()

function(samara_add_scripts folder label prefix)
  set(directory ${PROJECT_SOURCE_DIR}/tests/${folder})
  file(GLOB scripts CONFIGURE_DEPENDS ${directory}/*.sh ${directory}/*.py)
  foreach(script ${scripts})
    get_filename_component(stem ${script} NAME_WE)
    set(interpreter bash)
    if(script MATCHES "[.]py$")
      set(interpreter ${SAMARA_PYTHON})
    endif()
    samara_add_ctest(${prefix}${stem} ${label} ${interpreter} ${script})
  endforeach()
endfunction()

# Harnesses: driven by libFuzzer where this is a build for clang with SAMARA_FUZZ, else by our own
# driver. The tests run the corpus and some changes of it.
set(samara_fuzz_corpus ${PROJECT_SOURCE_DIR}/tests/fuzz/corpus)
set(seeds_of_case ${samara_fuzz_corpus}/case ${PROJECT_SOURCE_DIR}/inputs)
set(seeds_of_formula ${samara_fuzz_corpus}/formula)
set(seeds_of_polar ${samara_fuzz_corpus}/polar)
set(seeds_of_result ${samara_fuzz_corpus}/result)
set(seeds_of_windio ${PROJECT_SOURCE_DIR}/tests/decks/files/windio)
set(seeds_of_openfast ${PROJECT_BINARY_DIR}/fuzz_seeds/openfast)
# A deck in one file, each of its files behind a line with its name.
foreach(deck teeter/Main three/Main three/Main_BeamDyn three/Main_curved three/Main_air)
  get_filename_component(folder ${PROJECT_SOURCE_DIR}/tests/decks/files/${deck} DIRECTORY)
  get_filename_component(main ${deck} NAME)
  file(GLOB others RELATIVE ${folder} ${folder}/*.dat ${folder}/*.wnd)
  set(joined "")
  foreach(file ${main}.fst ${others})
    file(READ ${folder}/${file} text)
    string(APPEND joined "==== ${file}\n${text}")
  endforeach()
  string(REPLACE "/" "_" name ${deck})
  file(WRITE ${seeds_of_openfast}/${name} "${joined}")
endforeach()

set(seeds_of_hawc2 ${PROJECT_BINARY_DIR}/fuzz_seeds/hawc2)
set(folder ${PROJECT_SOURCE_DIR}/tests/decks/files/htc)
set(joined "")
foreach(file htc/turbine.htc parts/bodies.htc parts/orientation.htc data/tower.st data/stiff.st
        data/blade.st data/layout.ae data/polars.pc)
  file(READ ${folder}/${file} text)
  # Files of an input are in one folder.
  string(REGEX REPLACE "[.]/(parts|data)/" "" text "${text}")
  string(REPLACE ".\\data\\Tower" "tower" text "${text}")
  get_filename_component(name ${file} NAME)
  string(APPEND joined "==== ${name}\n${text}")
endforeach()
file(WRITE ${seeds_of_hawc2}/turbine "${joined}")

function(samara_add_fuzz_tests libraries)
  set(directory ${PROJECT_SOURCE_DIR}/tests/fuzz)
  file(GLOB harnesses CONFIGURE_DEPENDS ${directory}/*_harness.cpp)
  add_custom_target(fuzz)
  foreach(harness ${harnesses})
    get_filename_component(name ${harness} NAME_WE)
    string(REPLACE "_harness" "" name ${name})
    set(target fuzz_${name})
    add_executable(${target} ${harness} ${directory}/folder.cpp)
    target_link_libraries(${target} PRIVATE ${libraries})
    target_compile_definitions(${target} PRIVATE SAMARA_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    if(SAMARA_FUZZ AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
      target_link_options(${target} PRIVATE -fsanitize=fuzzer)
    else()
      target_sources(${target} PRIVATE ${directory}/driver.cpp)
    endif()
    add_dependencies(fuzz ${target})
    string(REPLACE ";" "\n" seeds "${seeds_of_${name}}")
    file(WRITE ${PROJECT_BINARY_DIR}/fuzz_seeds/${name}.list "${seeds}\n")
    samara_add_ctest(${target} unit ${target} -seed=1 -runs=500 -timeout=60
                     -artifact_prefix=${PROJECT_BINARY_DIR}/tests/${name}- ${seeds_of_${name}})
  endforeach()
endfunction()

file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
foreach(room base math petsc elements model turbine linear loads)
  samara_add_tests(${room} unit samara::${room})
endforeach()
samara_add_tests(analysis unit "samara::analysis;samara::turbine")
samara_add_tests(simulation unit "samara::simulation")
samara_add_tests(io unit "samara::io;samara_external_files")
samara_add_tests(decks unit "samara::decks;samara_external_files")
samara_add_tests(verification verification "samara::io;samara_external_files")
samara_add_fuzz_tests("samara::decks;samara_external_files")
file(GLOB controllers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/controllers/*.c)
foreach(source ${controllers})
  get_filename_component(name ${source} NAME_WE)
  add_library(controller_${name} MODULE ${source})
  target_link_libraries(controller_${name} PRIVATE m)
  set_target_properties(
    controller_${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name} LIBRARY_OUTPUT_DIRECTORY
                                  ${PROJECT_BINARY_DIR}/tests/controllers)
endforeach()
add_executable(dump_system ${PROJECT_SOURCE_DIR}/tests/dump/dump.cpp)
target_link_libraries(dump_system PRIVATE samara::io samara_external_files)
samara_add_scripts(layering tree "")
if(TARGET samara_program)
  samara_add_scripts(drivers program program_)
endif()
