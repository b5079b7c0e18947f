# Refuses compiler flags that let the compiler change floating-point results. Gyre promises the same bits for every
# compiler, width and thread count; with one of these flags the promise is broken without any message, so it is an error
# here, before anything is compiled.

function(gyre_refuse_unsafe_float_flags where flags)
  set(unsafe
    -ffast-math -Ofast -funsafe-math-optimizations -fassociative-math -freciprocal-math -ffinite-math-only
    -fno-signed-zeros -fsingle-precision-constant -fcx-limited-range -ffp-contract=fast -ffp-contract=on
    -ffp-model=fast -ffp-model=aggressive -mfpmath=387 -mfpmath=both -mrecip -fapprox-func /fp:fast -fp:fast)
  string(REPLACE ";" " " flags "${flags}")
  separate_arguments(words UNIX_COMMAND "${flags}")
  foreach(word IN LISTS words)
    # The value after an equals sign of -mrecip does not matter; any use of it is an estimate.
    string(REGEX REPLACE "^(-mrecip)=.*" "\\1" plain "${word}")
    if(plain IN_LIST unsafe)
      message(FATAL_ERROR
        "Gyre cannot be built with '${word}' (found in ${where}).\n"
        "It lets the compiler reorder or replace floating-point operations, and then the same simulation gives "
        "different results on different machines. Remove the flag for Gyre; your own targets may keep it.")
    endif()
  endforeach()
endfunction()

get_directory_property(gyre_directory_options COMPILE_OPTIONS)
gyre_refuse_unsafe_float_flags("add_compile_options" "${gyre_directory_options}")
gyre_refuse_unsafe_float_flags("CMAKE_CXX_FLAGS" "${CMAKE_CXX_FLAGS}")
foreach(config IN ITEMS DEBUG RELEASE RELWITHDEBINFO MINSIZEREL)
  gyre_refuse_unsafe_float_flags("CMAKE_CXX_FLAGS_${config}" "${CMAKE_CXX_FLAGS_${config}}")
endforeach()
