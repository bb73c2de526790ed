#include "record/known.hpp"

#include "record/presence.hpp"
#include "record/layout/parts.hpp"
#include "record/reader.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

std::size_t index(int component) { return static_cast<std::size_t>(component); }

/// Keeps these rows, and columns where there are some, of vectors [size] or matrices [size, size].
void keep_rows(std::vector<double>& values, std::size_t size, const std::vector<int>& rows, bool matrices) {
    const std::size_t all = matrices ? size * size : size;
    auto to = values.begin();
    for (std::size_t first = 0; first < values.size(); first += all)
        for (const int i : rows) {
            if (!matrices) *to++ = values[first + index(i)];
            for (std::size_t j = 0; matrices && j < rows.size(); ++j)
                *to++ = values[first + index(i) * size + index(rows[j])];
        }
    values.erase(to, values.end());
}

}  // namespace

KnownSearch::KnownSearch(const RecordShape& shape)
    : shape_(shape), open_(index(shape.n), shape.has_errors), seen_(index(shape.n), 0) {
    for (std::size_t b = 0; b < shape.groups.size(); ++b)  // what a NEES of the record's own is of stays as it is
        for (const int j : members_of(shape.groups[b]))
            if (shape.source(b) == GroupSource::nees) open_[index(j)] = 0;
}

bool KnownSearch::goes_on() const { return std::ranges::count(open_, 1) > 0; }

void KnownSearch::see(const double* values) {
    for (std::size_t j = 0; j < open_.size(); ++j) {
        if (std::isnan(values[j])) continue;
        seen_[j] = 1;
        if (values[j] != 0) open_[j] = 0;
    }
}

void KnownSearch::start() { seen_.assign(seen_.size(), 0); }

void KnownSearch::end_errors() {
    for (std::size_t j = 0; j < open_.size(); ++j) open_[j] = open_[j] && seen_[j];
    start();
}

void KnownSearch::see_matrix(const double* values, const std::vector<int>& components) {
    const std::size_t size = components.size();
    for (std::size_t i = 0; i < size; ++i) {
        const std::size_t component = index(components[i]);
        if (!open_[component] || std::isnan(values[i * size + i])) continue;
        seen_[component] = 1;
        for (std::size_t j = 0; j < size; ++j)
            for (const double entry : {values[i * size + j], values[j * size + i]})
                if (!std::isnan(entry) && entry != 0) open_[component] = 0;
    }
}

void KnownSearch::see_covariances(const RecordStep& step) {
    if (step.covariance != nullptr && shape_.has_variances) see(step.covariance);
    else if (step.covariance != nullptr) see_matrix(step.covariance, counted_up(shape_.n));
    for (std::size_t b = 0; b < step.own.size(); ++b)
        if (step.own[b] != nullptr && shape_.source(b) == GroupSource::own)
            see_matrix(step.own[b], members_of(shape_.groups[b]));
}

std::vector<char> KnownSearch::known() const {
    std::vector<char> known = open_;
    for (std::size_t j = 0; j < known.size(); ++j) known[j] = known[j] && seen_[j];
    const bool all = std::ranges::count(known, 1) == std::ssize(known);
    return all || std::ranges::count(known, 1) == 0 ? std::vector<char>() : known;
}

RemainingState::RemainingState(const std::vector<char>& left_out, RecordLayout& layout) {
    RecordShape& shape = layout.shape;
    RecordShape all = shape;
    std::vector<DatasetPointer> own = std::move(layout.data.own);
    size_ = left_out.size();
    std::vector<int> place(size_, -1);
    shape.components.clear();
    for (int j = 0; j < all.n; ++j) {
        const Component component{component_name(all, j), all.components.empty() ? "" : all.components[index(j)].unit};
        if (left_out[index(j)]) {
            shape.known.push_back(component.name);
            continue;
        }
        place[index(j)] = static_cast<int>(kept_.size());
        kept_.push_back(j);
        shape.components.push_back(component);
    }
    shape.n = static_cast<int>(kept_.size());
    shape.groups.clear();
    shape.sources.clear();
    shape.group_epsilons.clear();
    layout.data.own.clear();
    for (std::size_t b = 0; b < all.groups.size(); ++b) {
        std::vector<int> rows, members;
        const std::vector<int> before = members_of(all.groups[b]);
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (place[index(before[i])] < 0) continue;
            rows.push_back(static_cast<int>(i));
            members.push_back(place[index(before[i])]);
        }
        if (members.empty()) {
            if (std::ranges::count(shape.known, all.groups[b].name) == 0)
                shape.known_groups.push_back(all.groups[b].name);
            continue;
        }
        shape.groups.push_back(group_of(all.groups[b].name, std::move(members)));
        if (!all.sources.empty()) shape.sources.push_back(all.sources[b]);
        if (!all.group_epsilons.empty()) shape.group_epsilons.push_back(all.group_epsilons[b]);
        layout.data.own.push_back(std::move(own[b]));
        in_group_.push_back(std::move(rows));
        group_size_.push_back(before.size());
    }
}

void RemainingState::keep(const RecordShape& shape, RecordValues& values) const {
    keep_rows(values.error, size_, kept_, false);
    keep_rows(values.covariance, size_, kept_, !shape.has_variances);
    keep_rows(values.truth_covariance, size_, kept_, true);
    for (std::size_t b = 0; b < values.own.size(); ++b)
        if (shape.source(b) == GroupSource::own) keep_rows(values.own[b], group_size_[b], in_group_[b], true);
}

}  // namespace credence
