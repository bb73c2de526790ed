#include "cli/process/limits.hpp"

#include "base/idle_threads.hpp"

#include <credence/error.hpp>

#include <omp.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>

namespace credence::cli {

namespace {

/// The largest scenarios (64 features, every estimator) take less than 128 kB on any thread.
constexpr std::size_t least_stack = std::size_t{256} << 10;

/// The stack size of the calling thread.
std::size_t own_stack() {
    std::size_t size = std::numeric_limits<std::size_t>::max();
    pthread_attr_t attributes;
    if (pthread_getattr_np(pthread_self(), &attributes) != 0) return size;
    pthread_attr_getstacksize(&attributes, &size);
    pthread_attr_destroy(&attributes);
    return size;
}

/// The smaller one of the first thread's stack and of other threads', which OMP_STACKSIZE may set.
std::size_t smallest_stack() {
    rlimit limit{};
    std::size_t smallest = getrlimit(RLIMIT_STACK, &limit) == 0 ? limit.rlim_cur : least_stack;
#pragma omp parallel num_threads(2) reduction(min : smallest)
    if (omp_get_thread_num() != 0) smallest = own_stack();
    end_idle_threads();
    return smallest;
}

/// The number in a file of this process's control group; nothing where there is no limit.
std::optional<std::int64_t> number_in(const std::string& path) {
    std::int64_t number = 0;
    if (std::ifstream(path) >> number && number > 0) return number;
    return std::nullopt;
}

}  // namespace

std::int64_t memory_limit() {
    std::int64_t least = std::int64_t{sysconf(_SC_PHYS_PAGES)} * sysconf(_SC_PAGESIZE);
    rlimit limit{};
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur < static_cast<rlim_t>(least))
        least = static_cast<std::int64_t>(limit.rlim_cur);
    for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"})
        if (const std::optional<std::int64_t> of_group = number_in(file)) least = std::min(least, *of_group);
    return least;
}

std::optional<std::int64_t> free_space(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code trouble;
    const std::filesystem::space_info space = std::filesystem::space(folder.empty() ? "." : folder, trouble);
    if (trouble || space.capacity == 0) return std::nullopt;  // such as /proc
    return static_cast<std::int64_t>(space.available);
}

void check_stack() {
    const std::size_t stack = smallest_stack();
    if (stack >= least_stack) return;
    throw InputError("cannot run with a stack of " + std::to_string(stack >> 10) + " kB",
                     "at least " + std::to_string(least_stack >> 10) + " kB are needed",
                     "Raise it by ulimit -s 8192, and leave OMP_STACKSIZE unset");
}

void allow_open_files() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace credence::cli
