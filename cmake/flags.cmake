# Flags of everything that computes. The bits of a result must not depend on the compiler's taste:
#   -ffp-contract=off         fused operations only where the source says fma
#   -fno-tree-slp-vectorize   g++ 12 forms fused operations in that pass even so
#   -fno-math-errno           sqrt becomes one instruction; its value is the same
add_library(credence_flags INTERFACE)
target_compile_options(credence_flags INTERFACE
  -Wall -Wextra -Wconversion -ffp-contract=off -fno-math-errno
  $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
if(CREDENCE_SANITIZE)
  target_compile_options(credence_flags INTERFACE -fsanitize=${CREDENCE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(credence_flags INTERFACE -fsanitize=${CREDENCE_SANITIZE})
endif()
