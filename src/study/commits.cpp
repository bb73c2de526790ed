#include "study/run.hpp"

namespace credence {

namespace {

std::int64_t size_of(const ScenarioResults& results) { return totals_size(results, results.detailed()); }

}  // namespace

Commits::Commits(const Study& study, const RunOptions& options)
    : keeper_(options.keeper), most_totals_(options.most_totals) {
    for (const ScenarioResults& results : study.scenarios)
        if (has_totals(results)) loaded(results);
}

void Commits::wait_for_room(std::unique_lock<std::mutex>& lock) {
    if (keeper_ == nullptr || !keeper_->full()) return;
    lock.unlock();
    { const std::lock_guard until_committed(committing_); }
    lock.lock();
}

void Commits::loaded(const ScenarioResults& results) { held_ += size_of(results); }

void Commits::finished(const Study& study, std::size_t scenario) {
    finished_.push_back(scenario);
    finished_size_ += size_of(study.scenarios[scenario]);
}

void Commits::take(std::size_t scenario, const Block& block) {
    if (keeper_ != nullptr) keeper_->take(scenario, block);
}

void Commits::take_back(std::size_t scenario, std::int64_t block) {
    if (keeper_ != nullptr) keeper_->take_back(scenario, block);
}

bool Commits::prepare_if_due(Study& study) {
    if (keeper_ == nullptr || !keeper_->due(too_much_held() ? finished_size_ : 0)) return false;
    prepare(study);
    return true;
}

void Commits::prepare(Study& study) {
    if (keeper_ == nullptr) return;
    keeper_->prepare(study);
    if (!too_much_held()) return;
    for (const std::size_t s : finished_)
        if (study.scenarios[s].kept_totals) drop_totals(study.scenarios[s]);
    finished_.clear();
    held_ -= finished_size_;
    finished_size_ = 0;
}

void Commits::commit() {
    if (keeper_ == nullptr) return;
    const std::lock_guard one(committing_);
    keeper_->commit();
}

}  // namespace credence
