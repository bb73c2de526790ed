#include "kernels.hpp"

#include "worlds/simulate.hpp"

namespace credence {

namespace bench_portable {
extern const bench::Kernels kernels;
}
#ifdef CREDENCE_X86_TARGETS
namespace bench_v3 {
extern const bench::Kernels kernels;
}
namespace bench_v4 {
extern const bench::Kernels kernels;
}
#endif

namespace bench {

std::vector<Kernels> runnable_kernels() {
    std::vector<Kernels> built{bench_portable::kernels};
#ifdef CREDENCE_X86_TARGETS
    built.push_back(bench_v3::kernels);
    built.push_back(bench_v4::kernels);
#endif
    std::vector<Kernels> runnable;
    for (const Target& target : runnable_targets())
        for (const Kernels& kernels : built)
            if (target.name == kernels.target) runnable.push_back(kernels);
    return runnable;
}

}  // namespace bench
}  // namespace credence
