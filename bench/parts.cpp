#include "parts.hpp"

#include <string>

namespace credence::bench {

namespace {

constexpr std::int64_t rounds = 1020;  // of draws six together

/// Two poses in a static world, every feature in sight: any number of steps is the same work.
const Problem& standing_problem() {
    static const Problem problem(scenario_with("part", {"features.path", "static", "scenario.poses", "2",
                                                        "sensor.range_min", "0", "sensor.range_max", "inf"}));
    return problem;
}

}  // namespace

void add_parts(const Effort& effort) {
    for (const Kernels& kernels : runnable_kernels()) {
        const std::string group = std::string("part/") + kernels.target + "/";
        add(group + "draws", effort, [kernels](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(kernels.normals(rounds));
            state.SetItemsProcessed(state.iterations() * rounds * 2 * kernels.lanes);
        });
        add(group + "filter_step", effort, [kernels](benchmark::State& state) {
            for (auto _ : state) benchmark::DoNotOptimize(kernels.filter_steps(standing_problem().view(), rounds));
            state.SetItemsProcessed(state.iterations() * rounds * kernels.lanes);
        });
        add_peak(group + "peak", kernels, effort);
    }
}

Table parts_table() {
    Table table{"parts",
                "Parts, by target (a filter step: predict, update, judge; heading model, M = 3, all in sight)",
                {"unit", "lanes", "FMA peak GFLOP/s", "ns/normal draw", "ns/filter step of a trial"},
                {}};
    for (const Kernels& kernels : runnable_kernels()) {
        std::map<std::string, Samples> samples = measure(std::string("part/") + kernels.target);
        const auto nanoseconds = [&](const char* name) {
            return 1e9 * median(samples[name].cpu) / (static_cast<double>(rounds) * kernels.lanes);
        };
        table.rows.push_back({kernels.target, kernels.lanes,
                              kernels.hardware_fma ? Json(peak_of(samples["peak"], kernels)) : Json(),
                              nanoseconds("draws") / 2, nanoseconds("filter_step")});
    }
    return table;
}

}  // namespace credence::bench
