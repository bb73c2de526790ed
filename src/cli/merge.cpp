#include "cli/command.hpp"
#include "cli/process/limits.hpp"
#include "cli/process/progress.hpp"

#include <credence/error.hpp>
#include "files/merge/merge.hpp"

namespace credence::cli {

namespace {

int merge(const Parsed& parsed) {
    if (parsed.arguments.empty()) throw InputError("no results file given", {}, "Name the files of the shards");
    const std::optional<Output> output = check_output_option(parsed);
    if (!output) throw InputError("no -o given", {}, "Name the results file to write");
    allow_open_files();
    for (const std::string& shard : parsed.arguments) check_kind(shard, {FileKind::results});
    const Study study = merge_results(parsed.arguments);
    if (!study.complete)
        throw Failure("blocks are missing: " + missing_text(study), {},
                      "Run or resume the shards that have them, then merge again");
    RunFacts facts = build_facts();
    facts.emplace_back("merged_files", std::to_string(parsed.arguments.size()));
    facts.emplace_back("command_line", parsed.line);
    write_results(*output, study, facts);
    if (!parsed.has("quiet"))
        print(printable(output->path) + ": " + std::to_string(study.trials) + " trials of each scenario from " +
              std::to_string(parsed.arguments.size()) + " files, " + file_size_text(output->path) + "\n");
    return 0;
}

}  // namespace

const Command& merge_command() {
    static const Command command{
        "merge",
        "SHARD.h5... -o FILE.h5 [options]",
        "make one results file of the files of shards",
        "\nThe files may come in any order, and no two may have the same block. The result is that of one run\n"
        "without shards. Exit code 1 where blocks are missing: their numbers b say which shards I/N to run or to\n"
        "resume, those with b mod N = I.\n",
        {output_option("the results file to write", "FILE.h5"),
         {"overwrite", "", "replace a results file that exists"},
         {"quiet", "", "say nothing where it goes well"}},
        merge};
    return command;
}

}  // namespace credence::cli
