#include "cli/run/ranks.hpp"

#include "cluster/mpi/mpi_transport.hpp"
#include "cli/process/interrupt.hpp"

#include <credence/error.hpp>
#include "cluster/launcher.hpp"

namespace credence::cli {

namespace {

/// `--option value` or `--option=value`
bool given(const std::vector<std::string>& arguments, const std::string& option, const std::string& value) {
    for (std::size_t i = 0; i < arguments.size(); ++i)
        if (arguments[i] == option + "=" + value ||
            (arguments[i] == option && i + 1 < arguments.size() && arguments[i + 1] == value))
            return true;
    return false;
}

}  // namespace

bool rank_0_says_it(const std::string& command, const std::vector<std::string>& arguments) {
    if (command != "run" || !rank_of_launcher(environment()) || given(arguments, "--mpi", "off") ||
        given(arguments, "--shard", "auto"))
        return false;
    const std::unique_ptr<Transport> post = start_mpi();
    return post && post->rank() > 0;
}

std::unique_ptr<Transport> transport_of(const Parsed& parsed) {
    const std::string mpi = parsed.choice("mpi");
    const bool own_shards = parsed.text("shard") == "auto";
    if (mpi == "on" && own_shards)
        throw InputError(
            "--mpi on and --shard auto contradict each other (every process would be a run of its own). Give "
            "one of them.");
    const std::optional<LauncherRank> launched = rank_of_launcher(environment());
    if (mpi == "off" || (mpi == "auto" && (own_shards || !launched))) return nullptr;
    const std::string named = launched ? "the environment has " + launched->names + ", but " : "";
    std::unique_ptr<Transport> post = start_mpi();
    if (!post)
        throw InputError(
            "cannot share the run among ranks (" + named +
            "this credence was built without MPI). Build it with "
            "-DCREDENCE_MPI=ON, make each process a run of its own: --shard auto -o 'part-{shard}.h5', or run "
            "alone: --mpi off.");
    if (launched && post->size() == 1)
        throw InputError("cannot share the run among ranks (" + named +
                         "MPI has started this process alone). Start it by the "
                         "mpirun of " +
                         mpi_library() + ", or run alone: --mpi off.");
    return post;
}

int follow_rank_0(Transport& post) {
    const Interrupt interrupt;
    try {
        follow(post, [] { return Interrupt::came() ? Interrupt::name() : std::string(); });
        return 0;
    } catch (...) {
        post.abandon();
        throw;
    }
}

}  // namespace credence::cli
