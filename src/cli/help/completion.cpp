// The script that completes command lines in bash, generated from the program's own descriptions of its commands.

#include "cli/command.hpp"
#include "cli/version.hpp"

#include <credence/error.hpp>
#include <credence/text.hpp>
#include <credence/worlds.hpp>

#include <algorithm>
#include <iostream>

namespace credence::cli {

const Command& completion_command() {
    static const Command command{"completion", "bash", "print the script that completes command lines in bash",
                                 "\nFor this shell alone: source <(credence completion bash). `cmake --install` puts it\n"
                                 "where bash-completion finds it.\n",
                                 {}};
    return command;
}

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
    std::vector<DescribedKey> keys{{world_key, first_world, "", {}}};
    for (const World* world : all_worlds()) keys.front().choices.push_back(world->name());
    for (const World* world : all_worlds())
        for (DescribedKey& key : world->keys())
            if (std::none_of(keys.begin(), keys.end(), [&](const DescribedKey& known) { return known.key == key.key; }))
                keys.push_back(std::move(key));
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

/// The part that does not depend on the commands. bash splits words at the = in COMP_WORDBREAKS: they are joined again,
/// and the part up to the = is removed from the replies, which replace only the part after it.
const char* const helpers = R"(
_credence_reply() {
    local reply
    while IFS= read -r reply; do
        if [[ $COMP_WORDBREAKS != *=* ]]; then reply=${current%"$value"}$reply
        elif [[ $value == *=* ]]; then reply=${reply#"${value%=*}="}
        fi
        COMPREPLY+=("$reply")
    done
}

_credence_words() { _credence_reply < <(compgen -W "$*" -- "$value"); }

# Words behind `section.key=`.
_credence_words_after() {
    local words=() word
    for word in $1; do words+=("${value%%=*}=$word"); done
    _credence_words "${words[@]}"
}

# Folders, and files of these extensions; `h5.journal` stands for the file that the journal is of.
_credence_files() {
    local extension
    compopt -o filenames 2>/dev/null
    if [[ $1 == '*' ]]; then _credence_reply < <(compgen -f -- "$value"); return; fi
    _credence_reply < <(compgen -d -- "$value")
    for extension; do
        if [[ $extension == *.journal ]]; then
            _credence_reply < <(compgen -f -X "!*.$extension" -- "$value" |
                while IFS= read -r extension; do printf '%s\n' "${extension%.journal}"; done)
        else
            _credence_reply < <(compgen -f -X "!*.$extension" -- "$value")
        fi
    done
}

)";

const char* const body_begin = R"(_credence() {
    local words=() word i glued= current option= value= command= options= again=
    COMPREPLY=()
    for ((i = 1; i <= COMP_CWORD; ++i)); do
        word=${COMP_WORDS[i]}
        if [[ $word == = && ${#words[@]} -gt 0 ]]; then
            words[-1]+='='; glued=1
        elif [[ $glued ]]; then
            words[-1]+=$word; glued=
        else
            words+=("$word")
        fi
    done
    current=${words[-1]-} value=$current
    if ((${#words[@]} > 1)); then command=${words[0]} option=${words[-2]}; fi
    if [[ $current == --*=* ]]; then option=${current%%=*} value=${current#*=}; fi
    case $command in
)";

const char* const body_end = R"(    esac
    # Options that are not there yet, or may be given again.
    local left=()
    for word in $options; do
        [[ " ${words[*]:0:${#words[@]}-1} " == *" $word "* && " $again " != *" $word "* ]] || left+=("$word")
    done
    _credence_words "${left[@]}"
}

complete -F _credence credence
)";

std::string script() {
    std::vector<std::string> names{"--help", "--version"};
    std::string cases;
    for (const Command* command : all_commands()) {
        names.push_back(command->name);
        cases += case_of(*command);
    }
    const std::string version = version_text();
    return "# Completion of command lines for bash: " + version.substr(0, version.find('\n')) +
           ", made by `credence completion bash`.\n" + helpers + keys_text() + body_begin + "        '') options='" +
           joined(names, " ") + "' ;;\n" + cases + body_end;
}

}  // namespace

int completion(const Parsed& parsed) {
    if (parsed.arguments.size() != 1) throw InputError("completion takes the name of a shell. Give bash.");
    if (parsed.arguments.front() != "bash")
        throw invalid_value("shell", parsed.arguments.front(), "only bash can be completed", "Give bash");
    std::cout << script();
    return 0;
}

}  // namespace credence::cli
