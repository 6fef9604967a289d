# Flags of every target.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion
                    $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast>
                    # g++ 12 sees overlaps in std::string that are not there (GCC bug 105651)
                    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-restrict>)
# Objects are in the program and in the shared library: functions may be inlined in both.
add_compile_options(-fno-semantic-interposition)
if(SAMARA_WERROR)
  add_compile_options(-Werror)
endif()

# Only libraries that are called are loaded: each one costs start-up time.
add_link_options(-Wl,--as-needed)

# A build that finds errors of memory and undefined behaviour (scripts/test --sanitize).
if(SAMARA_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all
                      -fno-omit-frame-pointer -g1 -O1)
  add_link_options(-fsanitize=address,undefined)
endif()

# Which code an input of a harness reaches (scripts/fuzz).
if(SAMARA_FUZZ)
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    add_compile_options(-fsanitize=fuzzer-no-link)
  else()
    add_compile_options(-fsanitize-coverage=trace-pc)
  endif()
endif()

# Hardening against memory errors, for targets that read files, which come from
# anywhere. Where elements are computed it costs 5 to 7 % of a run and guards nothing.
add_link_options(-Wl,-z,relro,-z,now)
function(samara_harden target)
  if(SAMARA_SANITIZE OR CMAKE_BUILD_TYPE STREQUAL "Debug")
    return()
  endif()
  target_compile_options(${target} PRIVATE -fstack-protector-strong -U_FORTIFY_SOURCE
                                           -D_FORTIFY_SOURCE=2)
endfunction()
