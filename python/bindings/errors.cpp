// Errors as Python's, which name arguments and calls.

#include "calls.hpp"

#include "base/wording.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

#include <nanobind/stl/string.h>

#include <algorithm>
#include <map>
#include <utility>

namespace credence::python {

namespace {

std::string quoted(const std::string& text) {
    std::string literal = "'";
    for (const char c : text) literal += c == '\'' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
    return literal + "'";
}

/// `margin_direction=0.2`, `keep='trials'`, `set={"noise.walk": "0.1"}`, `overwrite=True`.
std::string argument(const std::string& name, const std::string& value) {
    static const std::map<std::string, std::string> switches{{"overwrite", "overwrite=True"},
                                                             {"force", "force=True"},
                                                             {"resume", "credence.resume()"},
                                                             {"dry-run", "`credence run --dry-run`"}};
    if (const auto found = switches.find(name); found != switches.end()) return found->second;
    std::string argument = name;
    std::ranges::replace(argument, '-', '_');
    const std::size_t equals = value.find('=');
    if (value.empty()) return argument;
    if (name != "set" && name != "sweep") return argument + "=" + (to_number(value) ? value : quoted(value));
    if (equals == std::string::npos) return argument + " " + value;
    return argument + "={\"" + value.substr(0, equals) + "\": \"" + value.substr(equals + 1) + "\"}";
}

/// `credence.report('a.h5')`, where there is a function of that name.
std::string call(const std::vector<std::string>& words) {
    static const std::vector<std::string> functions{"run", "report", "judge", "compare", "replay", "merge", "show"};
    const std::string name = words.front();
    if (std::ranges::count(functions, name) == 0) return program_wording.command(words);
    if (words.back() == "--help") return "help(credence." + name + ")";
    if (words.back() == "--resume") return "credence.resume()";
    std::vector<std::string> arguments;
    for (std::size_t i = 1; i < words.size(); ++i)
        if (words[i].starts_with("--")) arguments.push_back(argument(words[i].substr(2), words[i + 1])), ++i;
        else arguments.push_back(quoted(words[i]));
    return "credence." + name + "(" + joined(arguments) + ")";
}

const Wording python_wording{argument, call, [](const std::string&) -> std::string { return "credence.resume()"; }};

/// Raises a class of Python with what the message is made of. Python takes no other text than UTF-8.
void raise(const char* name, const ComplaintError& error) {
    const nb::object type = nb::module_::import_("credence._errors").attr(name);
    const nb::object raised = type(shown(error.what()));
    const auto& [subject, reason, remedy, value, place] = error.complaint();
    using Part = std::pair<const char*, std::string>;
    for (const auto& [part, text] :
         {Part("subject", subject), Part("reason", reason), Part("remedy", remedy), Part("place", place)})
        raised.attr(part) = shown(text);
    if (value) raised.attr("value") = shown(*value);
    PyErr_SetObject(type.ptr(), raised.ptr());
}

}  // namespace

void bind_errors(nb::module_& module) {
    wording() = python_wording;
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const InputError& error) {
            raise("InputError", error);
        } catch (const Failure& error) {
            raise("Failure", error);
        }
    });
    module.def("speak_of_options", [](bool options) { wording() = options ? program_wording : python_wording; });
}

}  // namespace credence::python
