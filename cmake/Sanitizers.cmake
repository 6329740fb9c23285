# Instruments our own code; COLMAP and all libraries stay as they are. Each kind
# has a build folder of its own: scripts/sanitize.sh and scripts/fuzz.sh make them.

set(TAPA_SANITIZE "" CACHE STRING
    "Find faults while running: address (with undefined behaviour), thread, or \
fuzzer (with what address finds; needs clang); empty: no")
set_property(CACHE TAPA_SANITIZE PROPERTY STRINGS "" address thread fuzzer)

set(sanitizers_address address,undefined)
set(sanitizers_thread thread)
set(sanitizers_fuzzer address,undefined)
if(TAPA_SANITIZE)
  set(sanitizers ${sanitizers_${TAPA_SANITIZE}})
  if(NOT sanitizers)
    message(FATAL_ERROR "TAPA_SANITIZE is ${TAPA_SANITIZE}; it may be address, \
thread or fuzzer")
  endif()
  # What goes on after undefined behaviour would pass its test.
  target_compile_options(tapa_flags INTERFACE
    "$<$<COMPILE_LANGUAGE:C,CXX>:-fsanitize=${sanitizers};-fno-sanitize-recover=all;-fno-omit-frame-pointer;-g1>")
  add_link_options(-fsanitize=${sanitizers})
  if(TAPA_SANITIZE STREQUAL fuzzer)
    # Counts which code an input reaches.
    target_compile_options(tapa_flags INTERFACE -fsanitize=fuzzer-no-link)
  endif()
endif()
