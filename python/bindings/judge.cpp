// The verdict on arrays or on a file.

#include "calls.hpp"
#include "judge.hpp"

#include "cli/command.hpp"
#include "record/read.hpp"

#include <credence/detail/store.hpp>
#include <credence/error.hpp>
#include <credence/record.hpp>
#include <credence/report.hpp>
#include <credence/text.hpp>

#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <map>

namespace credence::python {

namespace {

using Array = nb::ndarray<nb::ro, nb::device::cpu>;
using Lists = std::map<std::string, std::vector<std::vector<std::string>>>;

/// A path, or a name that may be one, in the bytes of the file system, which need not be UTF-8.
std::string bytes_of(const nb::bytes& text) { return {text.c_str(), text.size()}; }

RecordArray described(const std::string& path, const Array& array, double epsilon) {
    RecordArray described{path, array.data(), RecordArray::Type::real64, {}, {}, epsilon};
    if (array.dtype() == nb::dtype<float>()) described.type = RecordArray::Type::real32;
    else if (array.dtype() != nb::dtype<double>())
        throw nb::type_error((path + " holds neither float64 nor float32").c_str());
    for (std::size_t axis = 0; axis < array.ndim(); ++axis) {
        described.extents.push_back(static_cast<std::int64_t>(array.shape(axis)));
        described.strides.push_back(array.stride(axis));
    }
    return described;
}

using Texts = std::map<std::string, std::string>;

template <class Read>
Said judgement(const std::string& name, const nb::dict& options, const Listener& listener, const Read& read) {
    const cli::Command& command = cli::judge_command();
    const cli::Parsed parsed = cli::parsed_of(command, {}, values_of(command, options));
    const Limits limits = cli::parse_limits(parsed);
    const int segments = cli::parse_segments(parsed);
    const Texts truth = cli::parse_truth(parsed);
    const auto progress = [&, due = Due()](const Progress& now) mutable {
        if (!due(now)) return;
        if (must_end()) throw Failure("the verdict was not finished (Python ended). Wait for it.");
        const nb::gil_scoped_acquire held;
        if (PyErr_CheckSignals() != 0) throw nb::python_error();
        if (listener) (*listener)(now.done, now.total);
    };
    return alone([&] {
        return Said{[report = make_record_report(read(progress, segments, truth), name, limits), name](
                        const std::string& format) { return cli::rendered(report, format, name, {}); }};
    });
}

using Arrays = std::map<std::string, std::pair<Array, double>>;
using Dimensions = std::map<std::string, int>;

RecordArrays record_of(const Arrays& arrays, const Texts& texts, const Lists& lists, const Dimensions& dimensions) {
    RecordArrays record{{}, texts, dimensions, lists};
    for (const auto& [path, array] : arrays) record.arrays.push_back(described(path, array.first, array.second));
    return record;
}

void check(const Arrays& arrays, const Texts& texts, const Lists& lists, const Dimensions& dimensions) {
    const RecordArrays record = record_of(arrays, texts, lists, dimensions);
    alone([&] { check_record(record); });
}

Said judge(const Arrays& arrays, const Texts& texts, const Lists& lists, const Dimensions& dimensions,
           const nb::dict& options, const nb::bytes& called, const Listener& listener) {
    const std::string name = bytes_of(called);
    const RecordArrays record = record_of(arrays, texts, lists, dimensions);
    return judgement(name, options, listener,
                     [&](const auto& progress, int segments, const Texts&) {
                         return read_record(record, name, progress, segments);
                     });
}

Said judge_file(const nb::bytes& file, const nb::dict& options, const Listener& listener) {
    const std::string path = bytes_of(file);
    return judgement(path, options, listener, [&](const auto& progress, int segments, const Texts& truth) {
        cli::check_kind(path, {cli::FileKind::record});
        return read_record(path, progress, segments, truth);
    });
}

/// Writes the totals of records of the same trials, which differ in their arms, as a results file.
void write_results_of(const std::vector<nb::bytes>& files, std::uint64_t seed, const nb::bytes& output) {
    alone([&] {
        Study study;
        study.root_seed = seed;
        for (const nb::bytes& file : files) {
            const std::string path = bytes_of(file);
            cli::check_kind(path, {cli::FileKind::record});
            Study one = study_of(read_record(path, {}, segments_off));
            ScenarioResults& results = one.scenarios.front();
            if (results.scenario.name == "run") results.scenario.name = "record";  // /run of a file is reserved
            std::vector<Component>& components = results.scenario.components;
            while (std::ssize(components) < results.state_size())
                components.push_back({"x" + std::to_string(components.size()), "1"});
            study.trials = one.trials;
            study.scenarios.push_back(std::move(results));
        }
        write_results(Output(bytes_of(output)), study, {});
        return true;
    });
}

}  // namespace

void bind_judge(nb::module_& module) {
    module.def("judge", judge, nb::arg("arrays"), nb::arg("texts"), nb::arg("lists"), nb::arg("dimensions"),
               nb::arg("options"), nb::arg("name"), nb::arg("progress").none());
    module.def("check", check, nb::arg("arrays"), nb::arg("texts"), nb::arg("lists"), nb::arg("dimensions"));
    module.def("write_results_of", write_results_of, nb::arg("records"), nb::arg("seed"), nb::arg("output"));
    module.def("judge_file", judge_file, nb::arg("path"), nb::arg("options"), nb::arg("progress").none());
}

}  // namespace credence::python
