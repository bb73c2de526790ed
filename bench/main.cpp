// Benchmarks of credence: parts, whole trials against the baselines A and B, growth, threads, the program. Ends with
// tables, or with the same as JSON.

#include "worlds/simulate.hpp"
#include <cstring>
#include <fstream>
#include <iostream>

#include "parts.hpp"
#include "statistics.hpp"
#include "whole.hpp"

namespace credence::bench {

namespace {

constexpr const char* usage =
    "credence_bench [--quick] [--json] [--benchmark_...]\n"
    "  --quick          few repetitions of everything, to see that it works: not for quoting\n"
    "  --json           the tables as JSON\n"
    "  --benchmark_...  Google Benchmark's own options: runs what they name, without the tables\n";

std::string cpu_model() {
    std::ifstream file("/proc/cpuinfo");
    std::string line, model = "unknown", family, number;
    const auto value = [&] { return line.substr(line.find(':') + 2); };
    while (std::getline(file, line) && !line.empty()) {
        if (line.starts_with("model name")) model = value();
        if (line.starts_with("cpu family")) family = value();
        if (line.starts_with("model\t")) number = value();
    }
    return family.empty() ? model : model + " (family " + family + ", model " + number + ")";
}

/// The conditions of the measurements.
Json context(const Effort& effort) {
    std::string targets;
    for (const Target& target : runnable_targets())
        targets += (targets.empty() ? "" : ", ") + target.name + " (" + std::to_string(target.lanes) + " lanes)";
    return {{"processor", cpu_model()},
            {"compiler", CREDENCE_BENCH_COMPILER},
            {"flags of credence", CREDENCE_BENCH_FLAGS},
            {"flags of A and B", CREDENCE_BENCH_BASELINE_FLAGS},
            {"targets", targets},
            {"input",
             "the seed's scenario but for what a row names: K = 20 poses (19 steps), M = 3; a trial is the truth "
             "with all draws, planning, filter, NEES, NIS and trace(P) at each step, for credence all its "
             "statistics too"},
            {"A", "plain dynamic Eigen, the formulas as they stand, S.inverse(); mt19937_64, normal_distribution"},
            {"B", "fixed-size Eigen, Cholesky, nothing on the heap; the same noise"},
            {"agreement", "columns of A, B and credence on credence's draws, trial by trial, within 1e-9: checked"},
            {"bar",
             "what x A / x B should reach on a core that executes AVX-512 in full width; half of it on one that does "
             "so in two halves (v4's peak is v3's) or not at all"},
            {"operations",
             "+ - * / sqrt 1, fma 2, counted by running the engine on a counting number; not the "
             "generator's whole numbers"},
            {"% of peak", "of fused multiply-adds at the unit's width, measured among the row's own benchmarks"},
            {"times", "medians of " + std::to_string(effort.repetitions()) +
                          " repetitions in random order, CPU time of the thread unless it says wall"}};
}

void print(const Json& facts, const std::vector<Table>& tables, bool as_json) {
    if (as_json) {
        Json document{{"context", facts}, {"tables", Json::object()}};
        for (const Table& table : tables) document["tables"][table.key] = json_of(table);
        std::cout << document.dump(1) << "\n";
        return;
    }
    for (const auto& [name, text] : facts.items()) std::cout << name << ": " << text.get<std::string>() << "\n";
    for (const Table& table : tables) std::cout << "\n" << text_of(table);
}

std::vector<Table> measure_all(const Effort& effort) {
    std::vector<Table> tables{parts_table()};
    for (const Table& table : trial_tables("trials", "Whole trials", seed_rows())) tables.push_back(table);
    for (const Table& table : trial_tables("growth", "Growth with M (heading, straight, constant)", growth_rows()))
        tables.push_back(table);
    tables.push_back(estimators_table());
    tables.push_back(statistics_table(seed_rows()));
    tables.push_back(threads_table(effort));
    tables.push_back(program_table(effort));
    return tables;
}

int run(int argc, char** argv) {
    Effort effort;
    bool as_json = false, plain = false;
    std::vector<char*> passed{argv[0]};
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--quick"))
            effort.quick = true;
        else if (!std::strcmp(argv[i], "--json"))
            as_json = true;
        else if (!std::strncmp(argv[i], "--benchmark_", 12))
            plain = true, passed.push_back(argv[i]);
        else
            return std::cerr << usage, std::strcmp(argv[i], "--help") ? 2 : 0;
    }
    std::string interleaved = "--benchmark_enable_random_interleaving=true";
    passed.push_back(interleaved.data());
    int count = static_cast<int>(passed.size());
    passed.push_back(nullptr);
    benchmark::Initialize(&count, passed.data());
    add_parts(effort);
    add_trials(seed_rows(), effort);
    add_trials(growth_rows(), effort);
    add_estimators(effort);
    add_statistics(seed_rows(), effort);
    add_threads(effort);
    add_program(effort);
    if (plain) return benchmark::RunSpecifiedBenchmarks(), 0;

    std::cerr << "comparing the columns of A, B and credence" << std::endl;
    require_agreement(seed_rows(), effort);
    require_agreement(growth_rows(), effort);
    print(context(effort), measure_all(effort), as_json);
    return 0;
}

}  // namespace

}  // namespace credence::bench

int main(int argc, char** argv) {
    try {
        return credence::bench::run(argc, argv);
    } catch (const std::exception& trouble) {
        std::cerr << "error: " << trouble.what() << "\n";
        return 1;
    }
}
