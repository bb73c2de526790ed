// The script that completes command lines in bash, generated from the program's own descriptions of its commands.

#include "cli/command.hpp"
#include "embedded/completion.hpp"

#include "base/wording.hpp"
#include <credence/error.hpp>
#include <credence/text.hpp>
#include <credence/detail/worlds.hpp>

#include <algorithm>
#include <cctype>
#include <iostream>

namespace credence::cli {

namespace {

/// `ini` for `SCENARIO.ini`, the extension of the files that such a word denotes; `*` for `FILE`; nothing for another
/// word.
std::string extension_of(const std::string& word) {
    const std::size_t end = word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ");
    if (end == std::string::npos) return word == "FILE" ? "'*'" : "";
    if (end == 0 || word[end] != '.') return "";
    const std::size_t last = word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789", end + 1);
    return word.substr(end + 1, (last == std::string::npos ? word.size() : last) - end - 1);
}

/// Completions of a command's arguments: the extensions of the files that its synopsis names outside options, or its
/// literal words.
std::string arguments_reply(const Command& command) {
    std::vector<std::string> extensions, words;
    std::string before;
    for (std::string word : split_list(command.arguments, ' ')) {
        const bool of_option = before.starts_with("-");
        if (word.starts_with("[")) word = word.substr(1);
        before = word;
        const std::string extension = extension_of(word);
        const bool literal = word.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == std::string::npos;
        if (of_option) continue;
        if (!extension.empty()) extensions.push_back(extension);
        else if (literal && !word.empty()) words.push_back(word);
    }
    // A run that can be resumed may have only its journal.
    if (command.name == "watch") extensions.push_back("h5.journal");
    if (!extensions.empty()) return "_credence_files " + joined(extensions, " ");
    return words.empty() ? "" : "_credence_words " + joined(words, " ");
}

/// The completion of an option's value; empty where there is none.
std::string value_reply(const Option& option) {
    if (option.value.starts_with("section.key=")) return "_credence_keys";
    if (!option.choices.empty()) return "_credence_words " + joined(option.choices, " ");
    const std::string extension = extension_of(option.value);
    return extension.empty() ? ":" : "_credence_files " + extension;
}

std::string patterns_of(const Option& option) {
    return "--" + option.long_name() + (option.short_name().empty() ? "" : "|-" + option.short_name());
}

/// One branch of `case $command in`: the command's options, those that may be repeated, and the completion of each
/// value.
std::string case_of(const Command& command) {
    std::vector<std::string> options{"--help"}, again;
    std::string values;
    for (const Option& option : command.options) {
        options.push_back("--" + option.long_name());
        if (option.repeatable) again.push_back("--" + option.long_name());
        if (!option.value.empty())
            values += "                " + patterns_of(option) + ") " + value_reply(option) + "; return ;;\n";
    }
    const std::string arguments = arguments_reply(command);
    return "        " + command.name + ")\n            options='" + joined(options, " ") + "' again='" +
           joined(again, " ") + "'\n" +
           (values.empty() ? "" : "            case $option in\n" + values + "            esac\n") +
           "            [[ $current == -* ]] || { " + (arguments.empty() ? ":" : arguments) + "; return; } ;;\n";
}

/// The key of the world, and the keys of all worlds; where several worlds have a key, the first one's choices.
std::vector<DescribedKey> every_key() {
    std::vector<DescribedKey> keys{described_world()};
    for (const World* world : all_worlds())
        for (DescribedKey& key : world->keys())
            if (std::ranges::count(keys, key.key, &DescribedKey::key) == 0) keys.push_back(std::move(key));
    return keys;
}

/// The keys of a scenario, and the values of those that have choices.
std::string keys_text() {
    std::vector<std::string> names;
    std::string cases;
    for (const DescribedKey& key : every_key()) {
        names.push_back(key.key + "=");
        if (!key.choices.empty())
            cases += "        " + key.key + "=*) _credence_words_after '" + joined(key.choices, " ") + "' ;;\n";
    }
    return "_credence_keys() {\n    case $value in\n" + cases + "        *=*) ;;\n        *) _credence_words " +
           joined(names, " ") + "\n           compopt -o nospace 2>/dev/null ;;\n    esac\n}\n\n";
}

/// The script with what depends on the commands in its places. bash splits words at the = in COMP_WORDBREAKS: the
/// script joins them again, and removes the part up to the = from the replies, which replace only the part after it.
std::string filled(std::string script, const std::string& place, const std::string& text) {
    return script.replace(script.find(place), place.size(), text);
}

/// The script with this program's name, also in those of its functions: a shell may have scripts of several programs.
std::string of_program(std::string script) {
    std::string identifier = "_";
    for (const char c : program_name()) identifier += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    const std::string usual = "_credence";
    for (std::size_t at = 0; (at = script.find(usual, at)) != std::string::npos; at += identifier.size())
        script.replace(at, usual.size(), identifier);
    return filled(std::move(script), "@PROGRAM@", shell_word(program_name()));
}

std::string script() {
    std::vector<std::string> names{"--help", "--version"};
    std::string cases;
    for (const Command* command : all_commands()) {
        names.push_back(command->name);
        cases += case_of(*command);
    }
    const std::string version = version_text();
    std::string text = filled(embedded::completion, "@KEYS@", keys_text());
    text = filled(text, "@NAMES@", joined(names, " "));
    return "# Completion of command lines for bash: " + version.substr(0, version.find('\n')) + ", made by `" +
           program_name() + " completion bash`.\n\n" + of_program(filled(text, "@COMMANDS@", cases));
}

int completion(const Parsed& parsed) {
    if (parsed.arguments.size() != 1) throw InputError("completion takes the name of a shell", {}, "Give bash");
    if (parsed.arguments.front() != "bash")
        throw invalid_value("shell", parsed.arguments.front(), "only bash can be completed", "Give bash");
    std::cout << script();
    return 0;
}

}  // namespace

const Command& completion_command() {
    static const Command command{"completion", "bash", "print the script that completes command lines in bash",
                                 "\nFor this shell alone: source <(" + program_name() +
                                     " completion bash). `cmake --install` puts it\n"
                                 "where bash-completion finds it.\n",
                                 {},
                                 completion};
    return command;
}

}  // namespace credence::cli
