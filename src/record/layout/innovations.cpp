// Innovations alone, such as a flight log's: they are judged as errors whose covariance is S.

#include "record/layout/parts.hpp"

#include "base/nan.hpp"

#include <algorithm>
#include <cmath>

namespace credence {

namespace {

/// S, with NaN for the rows that are not observed.
DatasetPointer observed_covariance(const DatasetPointer& S, const DatasetPointer& nu) {
    const auto read = [=](const RecordExtents& first, const RecordExtents& count, std::vector<double>& values) {
        S->read(first, count, values);
        const RecordExtents start(first.begin(), first.end() - 1), size(count.begin(), count.end() - 1);
        const std::size_t m = count.back();
        std::vector<double> innovation(values.size() / m);
        nu->read(start, size, innovation);
        for (std::size_t i = 0; i < values.size(); ++i)
            if (std::isnan(innovation[i / m]) || std::isnan(innovation[i / (m * m) * m + i % m])) values[i] = nan;
    };
    return std::make_shared<RecordDataset>(S->place(), S->extents(), S->epsilon(), S->chunk(), read);
}

/// The innovations of a record under the names of errors.
class InnovationSource : public RecordSource {
public:
    explicit InnovationSource(const RecordSource& record) : record_(record) {}

    bool has(const std::string& path) const override { return !named(path).empty() && record_.has(named(path)); }
    DatasetPointer open(const std::string& path, Numbers numbers) const override {
        DatasetPointer dataset = record_.open(named(path), numbers);
        if (path != "covariance") return dataset;
        DatasetPointer innovation = record_.open("innovation", numbers);
        RecordExtents square = innovation->extents();
        square.push_back(square.back());
        if (dataset->extents() != square) return dataset;  // refused by name where it is checked
        return observed_covariance(dataset, innovation);
    }
    std::vector<std::string> names_in(const std::string&) const override { return {}; }
    bool has_attribute(const std::string& name, const std::string& path) const override {
        return path.empty() &&
               (name == "component_names" || (!attribute(name).empty() && record_.has_attribute(attribute(name))));
    }
    std::string text(const std::string& name, const std::string&) const override {
        return record_.text(attribute(name));
    }
    ListEntries list(const std::string& name) const override {
        if (name != "component_names") return record_.list(attribute(name));
        const std::uint64_t rows = record_.open("innovation")->extents().back();
        ListEntries names = record_.has_attribute(name) ? record_.list(name) : ListEntries();
        if (names.size() != rows) names.clear();
        while (names.size() < rows) names.push_back({"row_" + std::to_string(names.size())});
        return names;
    }
    std::optional<double> number(const std::string& name, const std::string&) const override {
        return record_.number(attribute(name));
    }

private:
    static std::string named(const std::string& path) {
        if (path == "error") return "innovation";
        if (path == "covariance") return "innovation_covariance";
        const bool same = path == "innovation" || path == "innovation_covariance" || path == "steps" || path == "time";
        return same ? path : "";
    }
    /// Row groups are the groups; what is said of the state's components is not said of rows.
    static std::string attribute(const std::string& name) {
        if (name == "groups") return "row_groups";
        return name == "record_version" || name == "row_groups" ? name : "";
    }

    const RecordSource& record_;
};

}  // namespace

bool has_innovations_alone(const RecordSource& source) {
    const auto has_any = [&](auto... paths) { return (source.has(paths) || ...); };
    return source.has("innovation") && !has_any("error", "covariance", "estimate", "truth", "nees") &&
           source.names_in("group").empty();
}

std::unique_ptr<RecordSource> innovations_of(const RecordSource& source) {
    return std::make_unique<InnovationSource>(source);
}

}  // namespace credence
