#include "cli/run/launcher.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <cstdlib>

namespace credence::cli {

namespace {

/// A place among several: a task of an array, or a process of a launcher.
struct Place {
    std::int64_t index = 0, count = 1;
};

const char* const give_shard = "Give --shard I/N";

InputError invalid_auto(const std::string& why, const std::string& remedy = give_shard) {
    return InputError("invalid --shard auto", why, remedy);
}

std::int64_t number_in(const Variables& variables, const std::string& name) {
    const std::optional<std::string> text = variables(name);
    if (!text) throw invalid_auto(name + " is not set, though others of its kind are");
    const std::optional<std::int64_t> number = to_integer(*text);
    if (!number) throw invalid_value(name, *text, "not a whole number, for --shard auto", give_shard);
    return *number;
}

std::int64_t number_in(const Variables& variables, const std::string& name, std::int64_t otherwise) {
    return variables(name) ? number_in(variables, name) : otherwise;
}

/// Throws where the place is invalid.
Place checked(const Place& place, const std::string& index_name, const std::string& count_name) {
    if (place.count < 1 || place.index < 0 || place.index >= place.count)
        throw invalid_auto(index_name + " and " + count_name + " say " + std::to_string(place.index) + " of " +
                           std::to_string(place.count));
    return place;
}

std::optional<Place> array_place(const Variables& variables) {
    const std::string array = "SLURM_ARRAY_TASK_", id_name = array + "ID";
    if (!variables(id_name)) return std::nullopt;
    const std::int64_t id = number_in(variables, id_name), first = number_in(variables, array + "MIN", 0),
                       step = number_in(variables, array + "STEP", 1), count = number_in(variables, array + "COUNT");
    if (step < 1) throw invalid_value(array + "STEP", std::to_string(step), "must be at least 1", give_shard);
    const std::int64_t last = number_in(variables, array + "MAX", first + (count - 1) * step);
    if (last != first + (count - 1) * step || (id - first) % step != 0)
        throw invalid_auto("task " + std::to_string(id) + " is of an array that is no range: " + std::to_string(count) +
                               " tasks from " + std::to_string(first) + " to " + std::to_string(last) + ", step " +
                               std::to_string(step),
                           "Submit a range such as --array=0-7, or give --shard I/N");
    return checked({(id - first) / step, count}, id_name, array + "COUNT");
}

std::optional<Place> process_place(const Variables& variables) {
    for (const std::string mpirun : {"OMPI_COMM_WORLD_", "PMI_"})
        if (const std::string index = mpirun + "RANK", count = mpirun + "SIZE"; variables(index))
            return checked({number_in(variables, index), number_in(variables, count)}, index, count);
    const bool batch_script = variables("SLURM_JOB_ID") && !variables("SLURM_STEP_ID");
    if (!variables("SLURM_PROCID") || batch_script) return std::nullopt;
    const std::string size = variables("SLURM_STEP_NUM_TASKS") ? "SLURM_STEP_NUM_TASKS" : "SLURM_NTASKS";
    return checked({number_in(variables, "SLURM_PROCID"), number_in(variables, size)}, "SLURM_PROCID", size);
}

}  // namespace

Variables environment() {
    return [](const std::string& name) -> std::optional<std::string> {
        const char* text = std::getenv(name.c_str());
        return text != nullptr ? std::optional<std::string>(text) : std::nullopt;
    };
}

Shard parse_shard(const std::string& text) {
    const std::size_t slash = text.find('/');
    const std::optional<std::int64_t> index = to_integer(text.substr(0, slash)),
                                      count = slash == std::string::npos ? std::nullopt
                                                                         : to_integer(text.substr(slash + 1));
    if (!index || !count || *count < 1 || *index < 0 || *index >= *count)
        throw invalid_value("--shard", text, "must be I/N with I from 0 to N - 1, or auto",
                            "Write --shard 0/4, 1/4 ...");
    return {*index, *count};
}

Shard shard_of_launcher(const Variables& variables) {
    const std::optional<Place> task = array_place(variables), process = process_place(variables);
    if (!task && !process)
        throw invalid_auto("the variables of a task of a Slurm array, of srun and of mpirun are not in the environment",
                           "Start it by one of them, or give --shard I/N");
    const Place outer = task.value_or(Place{}), inner = process.value_or(Place{});
    constexpr std::int64_t most = std::int64_t{1} << 31;
    if (outer.count > most || inner.count > most) throw invalid_auto("too many shards");
    return {outer.index * inner.count + inner.index, outer.count * inner.count};
}

}  // namespace credence::cli
