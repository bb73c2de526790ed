#include "oracle/own_simulation.hpp"

#include "oracle/batch_sums.hpp"
#include "worlds/own/recorder.hpp"

namespace credence {

namespace {

/// Hands everything on to another trial, and records the steps.
class RecordedTrial : public OwnTrial {
public:
    RecordedTrial(OwnTrial& trial, int rows, Trajectory& trajectory) : trial_(trial), recorder_(rows, trajectory) {}

    std::size_t arm() const override { return trial_.arm(); }
    int poses() const override { return trial_.poses(); }
    Eigen::Vector2d normal(int source, int pose, int index) const override {
        return trial_.normal(source, pose, index);
    }
    double uniform(int source, int pose, int index) const override { return trial_.uniform(source, pose, index); }
    void set(std::size_t column, double value) override { trial_.set(column, value); }
    void step(const Vector& error, const Matrix& P) override {
        recorder_.step(error, P);
        trial_.step(error, P);
    }
    void step(const Vector& error, const Matrix& P, const Vector& innovation, const Matrix& S) override {
        recorder_.step(error, P, innovation, S);
        trial_.step(error, P, innovation, S);
    }

private:
    OwnTrial& trial_;
    StepRecorder recorder_;
};

class OwnSimulation : public Simulation {
public:
    OwnSimulation(const Scenario& scenario, const OwnReport& report, std::function<void(OwnTrial&)> run)
        : case_(scenario, report, std::move(run)),
          shape_{scenario.poses, case_.shape.n, static_cast<int>(case_.columns.size()),
                 static_cast<int>(case_.all_series.list.size()), static_cast<int>(scenario.groups.size())} {}

    const SimulationShape& shape() const override { return shape_; }
    std::size_t workspace_size(std::size_t) const override { return 0; }
    void simulate(std::size_t arm, const Batch& batch) const override {
        EvaluatedTrial trial(case_, arm);
        trial.keep_moments(batch.moments != nullptr);
        BatchSums sums(case_, batch);
        std::vector<double> row;
        for (int i = 0; i < batch.trials; ++i) {
            trial.run(batch.root_seed, static_cast<std::uint64_t>(batch.first_trial + i));
            trial.columns(row);
            sums.add(i, trial, row);
        }
    }

    Trajectory replay(const Scenario& scenario, std::size_t arm, std::uint64_t root_seed,
                      std::int64_t trial) const override {
        Trajectory trajectory = empty_trajectory(scenario, scenario.arms[arm], case_.columns);
        trajectory.source = source_text(root_seed, trial);
        Case recorded = case_;
        recorded.run = [&](OwnTrial& evaluated) {
            RecordedTrial recording(evaluated, case_.report.largest_innovation, trajectory);
            case_.run(recording);
        };
        EvaluatedTrial evaluated(recorded, arm);
        evaluated.run(root_seed, static_cast<std::uint64_t>(trial));
        evaluated.columns(trajectory.column_values);
        fill_failed(trajectory.columns, trajectory.column_values.data());
        const Innovations innovations = case_.shape.has_innovations() ? Innovations::given : Innovations::none;
        add_evaluations(trajectory, case_.all_series, innovations, [&](std::size_t place) {
            const auto first = evaluated.all_series().begin() + static_cast<std::ptrdiff_t>(place * case_.steps());
            return std::vector<double>(first, first + static_cast<std::ptrdiff_t>(evaluated.steps_taken()));
        });
        return trajectory;
    }

private:
    Case case_;
    SimulationShape shape_;
};

}  // namespace

std::unique_ptr<const Simulation> one_at_a_time_simulation(const Scenario& scenario, const OwnReport& report,
                                                           std::function<void(OwnTrial&)> run) {
    return std::make_unique<OwnSimulation>(scenario, report, std::move(run));
}

}  // namespace credence
