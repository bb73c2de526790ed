#include "base/wording.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>

namespace credence {

const Wording program_wording{[](const std::string& name, const std::string& value) {
                                  return (name == "output" ? "-o" : "--" + name) + (value.empty() ? "" : " " + value);
                              },
                              [](const std::vector<std::string>& words) {
                                  std::string line = "`" + program_name();
                                  for (const std::string& word : words) line += " " + shell_word(word);
                                  return line + "`";
                              },
                              [](const std::string& command_line) { return command_line; }};

Wording& wording() {
    static Wording words = program_wording;
    return words;
}

std::string Complaint::text() const {
    const auto ended = [](const std::string& sentence) {
        return sentence + (sentence.empty() || sentence.ends_with('.') || sentence.ends_with('?') ? "" : ".");
    };
    std::string what = subject;
    if (value) what = "invalid " + printable(subject) + "=" + printable(*value);
    if (!reason.empty()) what += " (" + (value ? printable(reason) : reason) + ")";
    return (place.empty() ? "" : place + ": ") + ended(what) + (remedy.empty() ? "" : " " + ended(remedy));
}

}  // namespace credence
