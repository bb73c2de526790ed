// Records in arrays, as Python hands them over, of any ranks, extents, strides, numbers and texts: each is refused by
// an InputError of one line, or gets its verdict. An input is a list of choices; what it leaves open is 0.

#include "require.hpp"

#include <credence/error.hpp>
#include <credence/record.hpp>
#include <credence/report.hpp>

#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace credence;
using namespace credence::fuzz;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

/// The elements of an array, no more of them than it reaches, so that a sanitizer sees what is read beside them.
struct Elements {
    std::vector<double> doubles;
    std::vector<float> singles;
};

using Agreed = std::array<std::int64_t, 4>;

/// Extents of [trial, step, size, size] that mostly agree with those of other arrays.
std::vector<std::int64_t> any_extents(FuzzedDataProvider& choices, std::size_t rank, const Agreed& agreed) {
    std::vector<std::int64_t> extents(agreed.begin(), agreed.begin() + static_cast<std::ptrdiff_t>(rank));
    if (choices.ConsumeIntegralInRange(0, 15) < 15) return extents;
    extents.resize(choices.ConsumeIntegralInRange<std::size_t>(0, 6), 1);
    for (std::int64_t& extent : extents) extent = choices.ConsumeIntegralInRange<std::int64_t>(0, 3);
    return extents;
}

double any_number(FuzzedDataProvider& choices) {
    switch (choices.ConsumeIntegralInRange(0, 7)) {
        case 7: return choices.PickValueInArray({nan, infinity, -infinity, 0.0, 1e308, -1e200, 1e-308, 1e13});
        case 6: return choices.ConsumeFloatingPoint<double>();
        default: return choices.ConsumeIntegral<std::int8_t>() / 16.0;
    }
}

/// Symmetric where it is a matrix, often, with a strong diagonal.
double any_element(FuzzedDataProvider& choices, std::size_t i, const RecordArray& array) {
    const std::int64_t last = array.extents.empty() ? 1 : array.extents.back();
    const auto n = static_cast<std::size_t>(std::max<std::int64_t>(last, 1));
    const bool matrix = array.extents.size() > 1 && array.extents[array.extents.size() - 2] == array.extents.back();
    if (!matrix || choices.ConsumeIntegralInRange(0, 15) == 15) return any_number(choices);
    return i % n == i / n % n ? 2 : 0.5;
}

RecordArray any_array(FuzzedDataProvider& choices, const std::string& path, std::vector<std::int64_t> extents,
                      Elements& elements) {
    const bool single = choices.ConsumeBool();
    RecordArray array{path, nullptr, single ? RecordArray::Type::real32 : RecordArray::Type::real64,
                      std::move(extents), {}, choices.PickValueInArray({0x1p-52, 0x1p-23, 0x1p-10})};
    // Row-major, with gaps, backwards or again and again along any axis.
    std::int64_t stride = 1, first = 0, last = 0;
    for (auto extent = array.extents.rbegin(); extent != array.extents.rend(); ++extent) {
        const int way = choices.ConsumeIntegralInRange(0, 15);
        const std::int64_t own = way == 15 ? 0 : way == 14 ? -stride : way == 13 ? 2 * stride : stride;
        const std::int64_t reach = own * std::max<std::int64_t>(*extent - 1, 0);
        (reach < 0 ? first : last) += reach;
        array.strides.insert(array.strides.begin(), own);
        stride = std::max<std::int64_t>(last - first + 1, 1);
    }
    const auto size = static_cast<std::size_t>(last - first + 1);
    for (std::size_t i = 0; i < size; ++i) {
        const double element = any_element(choices, i, array);
        if (single) elements.singles.push_back(static_cast<float>(std::clamp(element, -3e38, 3e38)));
        else elements.doubles.push_back(element);
    }
    elements.singles.shrink_to_fit();
    elements.doubles.shrink_to_fit();
    array.data = single ? static_cast<const void*>(elements.singles.data() - first) : elements.doubles.data() - first;
    return array;
}

const char* any_text(FuzzedDataProvider& choices, const std::string& name) {
    if (name == "chart") return choices.PickValueInArray({"local", "global", "x"});
    if (name == "quaternion") return choices.PickValueInArray({"wxyz", "xyzw", ""});
    if (name == "manifold")
        return choices.PickValueInArray({"R1", "R2", "SO2", "SO2 x R1", "SE2", "SO3", "SE3", "R0", "R1000 x R1"});
    if (name.starts_with("component")) return choices.PickValueInArray({"a", "a, b", "a, b, c", "a, a", "m/s, 1, rad"});
    return choices.PickValueInArray(
        {"pose 0", "pose 0:2", "pose 1 0, rest 2", "rest 0 2", "x0 1", "all 0", "pose 9", "pose 0 0"});
}

/// A dataset of a record, and its extents where it fits the others.
struct Place {
    const char* path;
    std::size_t rank;
    Agreed extents;
};

std::vector<Place> any_places(FuzzedDataProvider& choices) {
    const auto extent = [&] { return choices.ConsumeIntegralInRange<std::int64_t>(1, 3); };
    const std::int64_t trials = extent(), steps = extent(), n = extent(), rows = extent(), d = extent(),
                       q = choices.PickValueInArray<std::int64_t>({n, n, 4, 7});
    const auto of = [&](std::int64_t size) { return Agreed{trials, steps, size, size}; };
    return {{"error", 3, of(n)}, {"covariance", choices.ConsumeBool() ? std::size_t{4} : std::size_t{3}, of(n)},
            {"truth", 3, of(q)}, {"estimate", 3, of(q)},
            {"innovation", 3, of(rows)}, {"innovation_covariance", 4, of(rows)},
            {"steps", 1, of(1)}, {"time", 2, of(1)}, {"nees", 2, of(1)},
            {"group/pose/covariance", 4, of(d)}, {"group/pose/nees", 2, of(1)}, {"group/rest/nees", 2, of(1)}};
}

void judge(FuzzedDataProvider& choices) {
    RecordArrays record;
    std::vector<std::unique_ptr<Elements>> elements;
    for (const Place& place : any_places(choices))
        if (choices.ConsumeBool())
            record.arrays.push_back(any_array(choices, place.path, any_extents(choices, place.rank, place.extents),
                                              *elements.emplace_back(std::make_unique<Elements>())));
    for (const char* name :
         {"groups", "row_groups", "component_names", "component_units", "manifold", "chart", "quaternion"})
        if (choices.ConsumeBool()) record.texts[name] = any_text(choices, name);
    for (const char* path : {"nees", "group/pose/nees", "group/rest/nees"})
        if (choices.ConsumeBool()) record.dimensions[path] = choices.ConsumeIntegralInRange(-1, 4);
    const Report report = make_record_report(read_record(record, "record"), "record", 0.05);
    require(!report_text(report).empty() && !report_json(report).empty(), "there is a report");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    FuzzedDataProvider choices(data, size);
    try {
        judge(choices);
    } catch (const InputError& error) {
        require_one_line(error.what());
    }
    return 0;
}
