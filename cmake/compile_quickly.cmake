# For what does not compute: -O1, where gcc 12 sees overruns in std::string's own copying, and under the sanitizers
# -Og, a third quicker (gcc 12 has no -O0 for Eigen behind a precompiled header).
function(talus_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1;-Wno-array-bounds;-Wno-stringop-overflow> $<$<CONFIG:RelWithDebInfo>:-Og>)
endfunction()
