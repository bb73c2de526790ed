// The Python module credence._core: the program, its commands, and the verdict on arrays.

#include "calls.hpp"
#include "judge.hpp"
#include "planners.hpp"

#include "cli/command.hpp"
#include "cli/process/interrupt.hpp"
#include "cli/process/progress.hpp"

#include <credence/error.hpp>
#include <credence/program.hpp>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <iostream>
#include <sstream>
#include <tuple>

namespace credence::python {

namespace {

/// What is written to a stream while the object exists.
class Captured {
public:
    explicit Captured(std::ostream& stream) : stream_(stream), before_(stream.rdbuf(text_.rdbuf())) {}
    ~Captured() { stream_.rdbuf(before_); }
    Captured(const Captured&) = delete;
    Captured& operator=(const Captured&) = delete;
    std::string text() const { return text_.str(); }

private:
    std::ostringstream text_;
    std::ostream& stream_;
    std::streambuf* before_;
};

/// While an object exists, progress goes to Python instead of the error stream.
class Listening {
public:
    explicit Listening(const Listener& listener) {
        cli::listen_to_progress([&listener, due = Due()](const Progress& now) mutable {
            if (!listener || !due(now)) return;
            const nb::gil_scoped_acquire held;
            try {
                (*listener)(now.done, now.total);
            } catch (nb::python_error& error) {
                error.discard_as_unraisable("credence: progress");  // no exception may leave a thread of a run
            }
        });
    }
    ~Listening() { cli::listen_to_progress({}); }
    Listening(const Listening&) = delete;
    Listening& operator=(const Listening&) = delete;
};

const cli::Command& command_of(const std::string& name) {
    for (const cli::Command* command : cli::all_commands())
        if (command->name == name) return *command;
    throw InputError("unknown command " + name + ".");
}

/// Runs a command, with planners of Python's. Returns its exit code, and what it would have printed on the standard
/// output and error stream.
std::tuple<int, std::string, std::string> command(const std::string& name, const std::vector<std::string>& arguments,
                                                  const nb::dict& options, const Listener& listener,
                                                  const nb::dict& given) {
    const Planners planners(given);
    const cli::Parsed parsed = cli::parsed_of(command_of(name), arguments, values_of(command_of(name), options));
    return alone([&] {
        cli::Interrupt::keep_process();
        const Captured out(std::cout), err(std::cerr);
        const Listening listening(listener);
        const Planners::Added added(planners);
        cli::check_process({name});
        const int code = cli::obey(parsed);
        return std::tuple(code, out.text(), err.text());
    });
}

void say(Said* said, const std::string& name, const std::vector<std::string>& arguments, const nb::dict& options) {
    const cli::Parsed parsed = cli::parsed_of(command_of(name), arguments, values_of(command_of(name), options));
    new (said) Said{alone([&]() -> cli::Rendering {
        if (name == "compare") return cli::compared(parsed);
        if (name == "budget") return cli::budgeted(parsed);
        return [of = name == "report" ? cli::reported(parsed) : cli::judged(parsed)](const std::string& format) {
            return cli::rendered(of.report, format, of.path, of.run);
        };
    })};
}

/// The program: the process is its own.
int run_program(const std::vector<nb::bytes>& arguments) {
    std::vector<std::string> words{"credence"};
    for (const nb::bytes& argument : arguments) words.emplace_back(argument.c_str(), argument.size());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    return alone([&] { return program(static_cast<int>(pointers.size()), pointers.data()); });
}

}  // namespace

NB_MODULE(_core, module) {
    nb::set_leak_warnings(false);  // a forked process and a daemon thread leave things behind
    bind_errors(module);
    module.def("command", command, nb::arg("name"), nb::arg("arguments"), nb::arg("options"),
               nb::arg("progress").none(), nb::arg("planners") = nb::dict());
    bind_planners(module);
    module.def("program", run_program, nb::arg("arguments"));
    nb::class_<Said>(module, "Said")
        .def("__init__", say, nb::arg("name"), nb::arg("arguments"), nb::arg("options"))
        .def("in_format", &Said::in, nb::arg("format"));
    bind_budget(module);
    bind_judge(module);
    bind_turns();
}

}  // namespace credence::python
