# etendue_add_plugin(gold gold.cpp …) builds libgold.so, to be named in a file: plugin "libgold.so"
function(etendue_add_plugin name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE etendue::etendue)
endfunction()
