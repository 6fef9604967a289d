# Flags of every target.
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion
                    $<$<COMPILE_LANGUAGE:CXX>:-Wold-style-cast>
                    # g++ 12 sees overlaps in std::string that are not there (GCC bug 105651)
                    $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
if(SAMARA_WERROR)
  add_compile_options(-Werror)
endif()

# Only libraries that are called are loaded: each one costs start-up time.
add_link_options(-Wl,--as-needed)
