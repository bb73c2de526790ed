#include <credence/record.hpp>

#include <limits>

namespace credence {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Figure nees_figure(const StateBlock& block) {
    const bool whole = block.name == "all";
    return {whole ? "nees" : "nees_" + block.name,
            "normalised estimation error squared of " + (whole ? std::string("the whole state") : block.name),
            "1", FigureRole::nees, block.count, false};
}

}  // namespace

const std::vector<std::string>& status_names() {
    static const std::vector<std::string> names{"completed", "diverged", "covariance_not_positive_definite",
                                                "non_finite"};
    return names;
}

std::vector<StateBlock> state_blocks(const Scenario& scenario) {
    const int pose = pose_size(scenario), n = state_size(scenario);
    std::vector<StateBlock> blocks{{"all", 0, n}, {"pose", 0, pose}};
    if (scenario.process == Process::heading) {
        blocks.push_back({"heading", 0, 1});
        blocks.push_back({"position", 1, 2});
    }
    blocks.push_back({"features", pose, n - pose});
    for (int j = 0; pose + 2 * j < n; ++j) blocks.push_back({"feature_" + std::to_string(j), pose + 2 * j, 2});
    return blocks;
}

std::vector<std::string> component_names(const Scenario& scenario) {
    std::vector<std::string> names;
    if (scenario.process == Process::heading) names.push_back("theta");
    names.insert(names.end(), {"r_x", "r_y"});
    for (std::size_t j = 0; j < scenario.features.positions.size(); ++j)
        for (const char* axis : {"_x", "_y"}) names.push_back(std::string("f").append(std::to_string(j)).append(axis));
    return names;
}

std::string trace_unit(const Scenario& scenario) {
    const std::string area = scenario.length_unit + "^2";
    return scenario.process == Process::heading ? area + " + rad^2" : area;
}

std::vector<Column> trial_columns(const Scenario& scenario) {
    return {{"trace_P", "trace of the covariance after the last update", trace_unit(scenario), ColumnType::real, nan},
            {"unseen", "features not seen, summed over the poses after the first", "1", ColumnType::integer, -1},
            {"pose_error", "squared error of the estimated pose, summed over all poses", trace_unit(scenario),
             ColumnType::real, nan},
            {"nees_ratio", "mean over the steps of NEES / state dimension", "1", ColumnType::real, nan},
            {"nis_ratio", "sum of NIS over the steps / sum of measurement rows", "1", ColumnType::real, nan},
            {"status", "how the trial ended", "1", ColumnType::status, 0},
            {"status_pose", "pose at which the status arose, -1 for none", "1", ColumnType::integer, -1}};
}

bool fill_failed(const std::vector<Column>& columns, double* values) {
    if (!failed(static_cast<Status>(static_cast<int>(values[column_status])))) return false;
    for (std::size_t c = 0; c < columns.size(); ++c)
        if (c != column_status && c != column_status_pose) values[c] = columns[c].fill;
    return true;
}

std::vector<Figure> step_figures(const Scenario& scenario) {
    std::vector<Figure> figures;
    for (const StateBlock& block : state_blocks(scenario)) figures.push_back(nees_figure(block));
    figures.push_back({"nis", "normalised innovation squared over all rows", "1", FigureRole::nis, 0, false});
    figures.push_back({"nis_rows", "measurement rows", "1", FigureRole::rows, 0, true});
    figures.push_back({"unseen_features", "features not seen", "1", FigureRole::other, 0, true});
    figures.push_back({"trace_P_step", "trace of the covariance after the update", trace_unit(scenario),
                       FigureRole::other, 0, false});
    figures.push_back({"squared_pose_error", "squared error of the estimated pose", trace_unit(scenario),
                       FigureRole::other, 0, false});
    for (const std::string& name : component_names(scenario))
        figures.push_back({"standardised_error_" + name, "error of " + name + " over its predicted standard deviation",
                           "1", FigureRole::standardised_error, 1, false});
    return figures;
}

}  // namespace credence
