#include "ranks.hpp"

#include "../mpi/mpi_post.hpp"
#include "interrupt.hpp"

#include <credence/error.hpp>
#include <credence/launcher.hpp>

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

bool follows_rank_0(const std::string& command, const std::vector<std::string>& arguments) {
    return command == "run" && rank_of_launcher(environment()).value_or(0) > 0 && !given(arguments, "--mpi", "off") &&
           !given(arguments, "--shard", "auto");
}

std::unique_ptr<Post> post_of(const Parsed& parsed) {
    const std::string mpi = parsed.choice("mpi");
    const bool own_shards = parsed.text("shard") == "auto";
    if (mpi == "on" && own_shards)
        throw InputError(
            "--mpi on and --shard auto contradict each other (every process would be a run of its own). Give "
            "one of them.");
    if (mpi == "off" || (mpi == "auto" && (own_shards || !rank_of_launcher(environment())))) return nullptr;
    std::unique_ptr<Post> post = start_mpi();
    if (!post)
        throw InputError(
            "cannot share the run among ranks (this credence was built without MPI). Build it with "
            "-DCREDENCE_MPI=ON, or make each process a run of its own: --shard auto -o 'part-{shard}.h5'.");
    return post;
}

int follow_rank_0(Post& post) {
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
