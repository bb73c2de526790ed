#include "worlds/own/lanes/one_by_one.hpp"

#include "base/nan.hpp"
#include "worlds/own/trial_ends.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace credence {

namespace {

std::size_t cells(int count) { return static_cast<std::size_t>(count); }

/// Draws of all lanes in the order in which the first trial asks for them: the others mostly ask in the same.
class SharedDraws {
public:
    using Draw = void (*)(const LanePack&, int source, int pose, int index, double* draw);

    SharedDraws(const LanePack& pack, int lanes) : pack_(pack), size_(2 * cells(lanes)), unshared_(size_) {}

    void start_lane(bool first) {
        first_ = first;
        next_ = 0;
    }
    /// [2, lanes], or [lanes]
    const double* numbers(Draw draw, int source, int pose, int index) {
        const Key key{draw, source, pose, index};
        if (first_) return append(key);
        const std::size_t end = std::min(next_ + farthest, keys_.size());
        for (std::size_t i = next_; i < end; ++i)
            if (keys_[i] == key) {
                next_ = i + 1;
                return &numbers_[i * size_];
            }
        draw(pack_, source, pose, index, unshared_.data());
        return unshared_.data();
    }

private:
    struct Key {
        Draw draw;
        int source, pose, index;
        friend bool operator==(const Key&, const Key&) = default;
    };
    static constexpr std::size_t farthest = 8;  ///< draws in a row that a trial may leave out

    const double* append(const Key& key) {
        keys_.push_back(key);
        numbers_.resize(keys_.size() * size_);
        double* to = &numbers_[(keys_.size() - 1) * size_];
        key.draw(pack_, key.source, key.pose, key.index, to);
        return to;
    }

    const LanePack& pack_;
    std::size_t size_, next_ = 0;
    bool first_ = true;
    std::vector<Key> keys_;
    std::vector<double> numbers_, unshared_;
};

/// The steps of a pack, as its lanes report them one after the other.
class LaneTrials : public OwnTrial {
public:
    LaneTrials(LanePack& pack, int lanes)
        : pack_(pack),
          lanes_(cells(lanes)),
          n_(pack.state_size),
          m_(pack.largest_innovation),
          draws_(pack, lanes),
          steps_(cells(pack.poses - 1)),
          errors_(steps_ * cells(n_) * lanes_),
          P_(steps_ * cells(n_ * n_) * lanes_),
          innovations_(steps_ * cells(m_) * lanes_, nan),
          S_(steps_ * cells(m_ * m_) * lanes_),
          has_innovation_(steps_) {}

    void run(const std::function<void(OwnTrial&)>& one, std::size_t lane) {
        lane_ = lane;
        step_ = 0;
        draws_.start_lane(lane == 0);
        if (!call_world(pack_, static_cast<int>(lane), 1, [&] { one(*this); })) return;
        if (step_ != steps_)
            throw WorldMistake("world " + *pack_.world + ": a trial took " + std::to_string(step_) + " steps, not " +
                               std::to_string(steps_) + ".");
    }
    /// Hands the steps of all lanes on.
    void evaluate() {
        for (std::size_t k = 0; k < steps_; ++k) {
            const int rows = has_innovation_[k] ? m_ : 0;
            const LaneStep step{at(errors_, k, n_), at(P_, k, n_ * n_), rows, at(innovations_, k, m_),
                                at(S_, k, m_ * m_)};
            if (!pack_.step(pack_, step)) leave(pack_);
        }
    }

    std::size_t arm() const override { return pack_.arm; }
    int poses() const override { return pack_.poses; }
    Eigen::Vector2d normal(int source, int pose, int index) const override {
        const double* draw = draws_.numbers(pack_.normal, source, pose, key_index(*pack_.world, source, pose, index));
        return {draw[lane_], draw[lanes_ + lane_]};
    }
    double uniform(int source, int pose, int index) const override {
        return draws_.numbers(pack_.uniform, source, pose, key_index(*pack_.world, source, pose, index))[lane_];
    }
    void set(std::size_t column, double value) override {
        if (column >= pack_.own_column_count) refuse(pack_, "a column that it does not have is set");
        pack_.own_columns[column * lanes_ + lane_] = value;
    }
    bool counting() const override { return pack_.counted != nullptr; }
    void counts(int source, const Matrix& P_s) override {
        if (!counting() || lane_ > 0) return;
        if (P_s.rows() != n_) refuse(pack_, "a P_s of another size than the state");
        pack_.count(pack_, source, Eigen::VectorXd(P_s.diagonal()).data(), 1);
    }
    void step(const Vector& error, const Matrix& P) override {
        take(error, P);
        end_step(error, P);
    }
    void step(const Vector& error, const Matrix& P, const Vector& innovation, const Matrix& S) override {
        if (innovation.size() > m_) refuse(pack_, "an innovation longer than innovation_rows");
        if (S.rows() != innovation.size() || S.cols() != innovation.size())
            refuse(pack_, "an S of another size than its innovation");
        take(error, P);
        double *nu = at(innovations_, step_, m_), *s = at(S_, step_, m_ * m_);
        for (Eigen::Index j = 0; j < innovation.size(); ++j) {
            nu[cells(static_cast<int>(j)) * lanes_ + lane_] = innovation(j);
            for (Eigen::Index i = j; i < innovation.size(); ++i)
                s[static_cast<std::size_t>(j * m_ + i) * lanes_ + lane_] = S(i, j);
        }
        has_innovation_[step_] = has_innovation_[step_] || innovation.size() > 0;
        end_step(error, P);
    }

private:
    double* at(std::vector<double>& all, std::size_t k, int count) { return all.data() + k * cells(count) * lanes_; }

    void take(const Vector& error, const Matrix& P) {
        if (step_ == steps_) refuse(pack_, "a trial took more steps than it has");
        if (error.size() != n_ || P.rows() != n_ || P.cols() != n_)
            refuse(pack_, "an error or P of another size than the state");
        double *e = at(errors_, step_, n_), *p = at(P_, step_, n_ * n_);
        for (Eigen::Index j = 0; j < n_; ++j) {
            e[static_cast<std::size_t>(j) * lanes_ + lane_] = error(j);
            for (Eigen::Index i = j; i < n_; ++i) p[static_cast<std::size_t>(j * n_ + i) * lanes_ + lane_] = P(i, j);
        }
    }
    /// A function that goes on with numbers that are not finite could go on for ever.
    void end_step(const Vector& error, const Matrix& P) {
        ++step_;
        if (!std::isfinite(error.sum() + P.diagonal().sum())) throw TrialEnds();
    }

    LanePack& pack_;
    std::size_t lanes_, lane_ = 0;
    int n_, m_;
    mutable SharedDraws draws_;
    std::size_t steps_, step_ = 0;
    std::vector<double> errors_, P_, innovations_, S_;  ///< [K - 1, .., lanes]
    std::vector<char> has_innovation_;                  ///< [K - 1] of any lane
};

}  // namespace

void run_one_by_one(const void* one_by_one, LanePack& pack) {
    const OneByOne& world = *static_cast<const OneByOne*>(one_by_one);
    LaneTrials trials(pack, world.lanes);
    for (int lane = 0; lane < pack.trials; ++lane) trials.run(world.run, cells(lane));
    trials.evaluate();
}

}  // namespace credence
