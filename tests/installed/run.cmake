# Installs the build into a fresh prefix, configures and builds a small project against it, and runs that and what is installed.
file(REMOVE_RECURSE ${WORK})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE printed)
  message(STATUS "${printed}")
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed (${status}): ${ARGN}")
  endif()
  set(printed "${printed}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER=${CXX})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/installed_user)
run(${WORK}/build/every_header)

# Libraries are named, or lie in the prefix: a path of another place is the one that they had on the machine that built this.
file(GLOB_RECURSE exported ${WORK}/prefix/*/vdb_shellTargets*.cmake)
list(LENGTH exported count)
if(count LESS 2)
  message(FATAL_ERROR "the exported targets are not where they were: ${exported}")
endif()
foreach(file ${exported})
  file(STRINGS ${file} paths REGEX "[:;\"]/[^;\"]*[.](so|a)[\";>]")
  if(paths)
    message(FATAL_ERROR "${file} has absolute paths: ${paths}")
  endif()
endforeach()

# The command as it is installed, without the libraries of the build.
file(GLOB command ${WORK}/prefix/bin/vdb_shell)
run(${command} --version)
if(NOT printed MATCHES "${VERSION}")
  message(FATAL_ERROR "the installed command tells another version than ${VERSION}: ${printed}")
endif()
run(${command} build ${MESH} --resolution 32 -q -o ${WORK}/box.vdb)
run(${command} check ${WORK}/box.vdb)
