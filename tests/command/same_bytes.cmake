# The library for processors with AVX2 makes the same tets, byte for byte, as the one for all:
# COMMAND run as it is, and by the loader LOADER with the folders for newer processors masked out.
function(run result)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE out COMMAND_ERROR_IS_FATAL ANY)
  set(${result} "${out}" PARENT_SCOPE)
endfunction()

set(masked ${LOADER} --glibc-hwcaps-mask none)
run(as_is ${LOADER} --list ${COMMAND})
run(plain ${masked} --list ${COMMAND})
if(plain MATCHES "glibc-hwcaps")
  message(FATAL_ERROR "the mask does nothing:\n${plain}")
endif()
if(NOT as_is MATCHES "glibc-hwcaps/x86-64-v3/libvdb_shell")
  message("this processor has no AVX2, or the loader knows no such folders")
  return()
endif()
file(MAKE_DIRECTORY ${WORK})
run(unused ${COMMAND} build ${MESH} -q -o ${WORK}/v3.vtu --resolution 96)
run(unused ${masked} ${COMMAND} build ${MESH} -q -o ${WORK}/plain.vtu --resolution 96)
execute_process(COMMAND ${CMAKE_COMMAND} -E compare_files ${WORK}/v3.vtu ${WORK}/plain.vtu
                COMMAND_ERROR_IS_FATAL ANY)
