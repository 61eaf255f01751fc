# etendue_python_preload: what has to be in the environment of a Python that loads libraries with sanitizers, while it has none
# itself: their library, loaded before all others. Empty in other builds.
set(etendue_python_preload "")
foreach(pair address=asan thread=tsan)
  string(REPLACE "=" ";" pair ${pair})
  list(GET pair 0 sanitizer)
  list(GET pair 1 library)
  if(ETENDUE_SANITIZE MATCHES ${sanitizer})
    execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=libclang_rt.${library}-x86_64.so
      OUTPUT_VARIABLE library OUTPUT_STRIP_TRAILING_WHITESPACE)
    set(etendue_python_preload LD_PRELOAD=${library} ASAN_OPTIONS=detect_leaks=0)
  endif()
endforeach()
