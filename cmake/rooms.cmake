# samara_add_room(<room> [PUBLIC <target>...] [PRIVATE <target>...])
# The library samara_<room> (alias samara::<room>) of src/<room>/*.cpp, header-only when there are
# none, with the targets it may use.
function(samara_add_room room)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "PUBLIC;PRIVATE")
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${room}/*.cpp)
  set(target samara_${room})
  set(SAMARA_ROOMS ${SAMARA_ROOMS} ${room} PARENT_SCOPE)
  if(sources)
    add_library(${target} STATIC ${sources})
    set(public PUBLIC)
    set(private PRIVATE)
  else()
    add_library(${target} INTERFACE)
    set(public INTERFACE)
    set(private INTERFACE)
  endif()
  add_library(samara::${room} ALIAS ${target})
  target_include_directories(${target} ${public} ${PROJECT_SOURCE_DIR}/include
                                                 ${PROJECT_BINARY_DIR}/include)
  target_link_libraries(${target} ${public} ${arg_PUBLIC} ${private} ${arg_PRIVATE})
endfunction()

# The program of drivers/*.cpp: the only place that may use every room. Users start `samara`, which
# becomes `samara-program`.
function(samara_add_program)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/drivers/*.cpp)
  if(sources)
    add_executable(samara_program ${sources})
    set_target_properties(samara_program PROPERTIES OUTPUT_NAME samara-program)
    target_link_libraries(samara_program PRIVATE samara::decks samara::io samara::simulation samara::fields samara::linear samara::loads
                                         samara::analysis samara::turbine samara::components
                                         samara::system samara::model samara::elements samara::math samara::petsc
                                         samara::base)
  endif()
  # Both use the C library alone, and stand beside the program.
  add_executable(samara_controller_host
                 ${PROJECT_SOURCE_DIR}/drivers/controller_host/controller_host.cpp)
  set_target_properties(samara_controller_host PROPERTIES OUTPUT_NAME samara-controller-host)
  target_include_directories(samara_controller_host PRIVATE ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(samara_controller_host PRIVATE ${CMAKE_DL_LIBS})
  add_executable(samara ${PROJECT_SOURCE_DIR}/drivers/launcher/launcher.cpp)
  target_include_directories(samara PRIVATE ${PROJECT_SOURCE_DIR}/drivers)
  if(SAMARA_SANITIZE)  # whose library would need milliseconds to start
    target_compile_options(samara PRIVATE -fno-sanitize=all)
    target_link_options(samara PRIVATE -fno-sanitize=all)
  endif()
  if(TARGET samara_program)
    add_dependencies(samara samara_program samara_controller_host)
  endif()
endfunction()
