// The shard that a launcher's environment names.

#include <credence/error.hpp>
#include "cli/run/launcher.hpp"
#include <credence/detail/store.hpp>

#include "catch.hpp"
#include "program.hpp"
#include "store_study.hpp"

#include <array>
#include <map>
#include <set>

namespace credence::test::launcher_test {

using namespace credence::cli;
using Catch::Contains;

namespace {

using Names = std::map<std::string, std::string>;

Variables variables(const Names& names) {
    return [names](const std::string& name) -> std::optional<std::string> {
        const auto found = names.find(name);
        return found == names.end() ? std::nullopt : std::optional<std::string>(found->second);
    };
}

std::string named(const Names& names) {
    const Shard shard = shard_of_launcher(variables(names));
    return std::to_string(shard.index) + "/" + std::to_string(shard.count);
}

std::string refused(const Names& names) {
    return refusal<InputError>([&] { shard_of_launcher(variables(names)); });
}

/// The variables that Slurm sets in task `id` of --array=FIRST-LAST:STEP (Slurm 22.05: MAX is the last task's, not
/// LAST).
Names array_task(int first, int last, int step, int id) {
    const int count = (last - first) / step + 1;
    return {{"SLURM_JOB_ID", "77"},
            {"SLURM_PROCID", "0"},
            {"SLURM_ARRAY_TASK_ID", std::to_string(id)},
            {"SLURM_ARRAY_TASK_MIN", std::to_string(first)},
            {"SLURM_ARRAY_TASK_MAX", std::to_string(first + (count - 1) * step)},
            {"SLURM_ARRAY_TASK_STEP", std::to_string(step)},
            {"SLURM_ARRAY_TASK_COUNT", std::to_string(count)}};
}

/// The variables that srun sets in process `id` of `count`.
Names step_task(int id, int count) {
    return {{"SLURM_JOB_ID", "77"},
            {"SLURM_STEP_ID", "0"},
            {"SLURM_STEP_NUM_TASKS", std::to_string(count)},
            {"SLURM_NTASKS", std::to_string(count)},
            {"SLURM_PROCID", std::to_string(id)}};
}

Names joined(Names names, const Names& others) {
    for (const auto& [name, value] : others) names[name] = value;
    return names;
}

}  // namespace

TEST_CASE("launcher: the tasks of any array range are all shards, each once") {
    const std::vector<std::array<int, 3>> ranges{{0, 7, 1}, {1, 8, 1},  {3, 10, 3},
                                                 {5, 5, 1}, {0, 15, 4}, {100, 106, 2}};
    for (const auto& [first, last, step] : ranges) {
        CAPTURE(first, last, step);
        std::set<std::int64_t> indices;
        const int count = (last - first) / step + 1;
        for (int id = first; id <= last; id += step) {
            const Shard shard = shard_of_launcher(variables(array_task(first, last, step, id)));
            CHECK(shard.count == count);
            indices.insert(shard.index);
        }
        CHECK(indices.size() == static_cast<std::size_t>(count));
        CHECK(*indices.begin() == 0);
        CHECK(*indices.rbegin() == count - 1);
    }
}

TEST_CASE("launcher: processes of srun and of mpirun are shards, in a task of an array as well") {
    CHECK(named(step_task(2, 4)) == "2/4");
    CHECK(named({{"OMPI_COMM_WORLD_RANK", "1"}, {"OMPI_COMM_WORLD_SIZE", "3"}}) == "1/3");
    CHECK(named({{"PMI_RANK", "0"}, {"PMI_SIZE", "2"}}) == "0/2");
    // Not the step's: mpirun is started by one process of a step, or starts its daemons by steps.
    CHECK(named(joined(step_task(0, 1), {{"OMPI_COMM_WORLD_RANK", "4"}, {"OMPI_COMM_WORLD_SIZE", "5"}})) == "4/5");
    CHECK(named({{"SLURM_PROCID", "3"}, {"SLURM_NTASKS", "4"}}) == "3/4");
    CHECK(named(joined(array_task(1, 3, 1, 2), step_task(3, 4))) == "7/12");
}

TEST_CASE("launcher: a batch script is one process, though Slurm counts its tasks in it") {
    const Names batch{{"SLURM_JOB_ID", "77"}, {"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "4"}};
    CHECK(named(joined(array_task(0, 7, 1, 5), batch)) == "5/8");
    CHECK_THAT(refused(batch), Contains("invalid --shard auto"));
}

TEST_CASE("launcher: what names no shard is refused") {
    CHECK_THAT(refused({}), Contains("invalid --shard auto (the variables of a task of a Slurm array") &&
                                Contains("give --shard I/N"));
    // --array=1,3,7: its numbers do not say which of the three a task is.
    for (const char* id : {"1", "3", "7"})
        CHECK_THAT(refused({{"SLURM_ARRAY_TASK_ID", id},
                            {"SLURM_ARRAY_TASK_MIN", "1"},
                            {"SLURM_ARRAY_TASK_MAX", "7"},
                            {"SLURM_ARRAY_TASK_STEP", "1"},
                            {"SLURM_ARRAY_TASK_COUNT", "3"}}),
                   Contains("an array that is no range: 3 tasks from 1 to 7, step 1"));
    const Names task = array_task(0, 8, 2, 4);
    REQUIRE(named(task) == "2/5");
    const auto with = [&](const std::string& name, const std::string& value) {
        return refused(joined(task, {{"SLURM_ARRAY_TASK_" + name, value}}));
    };
    CHECK_THAT(with("ID", "four"), Contains("SLURM_ARRAY_TASK_ID=four (not a whole number"));
    CHECK_THAT(with("ID", ""), Contains("not a whole number"));
    CHECK_THAT(with("ID", "5"), Contains("no range"));
    CHECK_THAT(with("ID", "10"), Contains("say 5 of 5"));
    CHECK_THAT(with("ID", "-2"), Contains("say -1 of 5"));
    CHECK_THAT(with("STEP", "0"), Contains("SLURM_ARRAY_TASK_STEP=0 (must be at least 1)"));
    CHECK_THAT(with("COUNT", "0"), Contains("no range"));
    CHECK_THAT(refused({{"SLURM_ARRAY_TASK_ID", "1"}}), Contains("SLURM_ARRAY_TASK_COUNT is not set"));
    CHECK_THAT(refused({{"OMPI_COMM_WORLD_RANK", "1"}}), Contains("OMPI_COMM_WORLD_SIZE is not set"));
    CHECK_THAT(refused(step_task(4, 4)), Contains("SLURM_PROCID and SLURM_STEP_NUM_TASKS say 4 of 4"));
}

TEST_CASE(
    "cli: run --shard auto computes the shard of its array task, under a name of its own; without one it does not "
    "run") {
    const Workplace here;
    here.write("small.ini",
               "[scenario]\nname = small\nposes = 2\n[arms]\ncontrollers = fixed\n[planner]\nspeeds = 1\n");
    const std::string run = " run small.ini --trials 1000 --quiet ";
    check_refused(here.credence(run + "--shard auto -o x.h5"),
                  "credence run: invalid --shard auto (the variables of a task of a Slurm array");
    const std::string task =
        "SLURM_ARRAY_TASK_MIN=4 SLURM_ARRAY_TASK_MAX=8 SLURM_ARRAY_TASK_STEP=2 "
        "SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_ID=6 " CREDENCE_PROGRAM;
    CHECK(here.shell(task + run + "--shard auto -o 'part-{shard}.h5'").exit_code == 0);
    REQUIRE(here.credence(run + "--shard 1/3 -o named.h5").exit_code == 0);
    CHECK(here.names() == std::vector<std::string>{"named.h5", "part-1.h5", "small.ini"});
    CHECK(here.shell("h5diff --exclude-path /run named.h5 part-1.h5").exit_code == 0);
    // Nothing but --shard auto listens to the launcher.
    CHECK(here.shell(task + run + "-o whole.h5").exit_code == 0);
    CHECK(read_results(here.path("whole.h5")).study.complete);
    check_refused(here.credence(run + "-o 'part-{shard}.h5'"), "there is no --shard that {shard} could stand for");
}

}  // namespace credence::test::launcher_test
