#include "cli/help/roff.hpp"

#include <credence/text.hpp>

#include "base/text_stream.hpp"

#include <algorithm>

namespace credence::cli::roff {

std::string plain(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '\\': escaped += "\\e"; break;
            case '-': escaped += "\\-"; break;
            case '\'': escaped += "\\(aq"; break;
            case '`': escaped += "\\(ga"; break;
            case '^': escaped += "\\(ha"; break;
            case '~': escaped += "\\(ti"; break;
            case '"': escaped += "\\(dq"; break;
            default: escaped += c;
        }
    }
    return escaped.starts_with(".") ? "\\&" + escaped : escaped;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

std::string section(const std::string& title) { return ".SH " + plain(title) + "\n"; }
std::string subsection(const std::string& title) { return ".SS " + plain(title) + "\n"; }

std::string filled(const std::string& text) {
    std::istringstream lines = stream_of(text.substr(std::min(text.size(), text.find_first_not_of('\n'))));
    std::string roff;
    bool as_it_is = false;
    for (std::string line; std::getline(lines, line);) {
        const bool now = line.starts_with(" ");
        if (now && !as_it_is) roff += ".RS 4\n.nf\n";
        if (!now && as_it_is) roff += ".fi\n.RE\n" + paragraph;
        as_it_is = now;
        roff += plain(trimmed(line)) + "\n";
    }
    return roff + (as_it_is ? ".fi\n.RE\n" : "");
}

std::string tagged(const std::string& tag, const std::string& text) {
    return ".TP\n" + tag + "\n" + plain(text) + "\n";
}

std::string example(const std::string& line) { return ".RS 4\n.nf\n" + plain(line) + "\n.fi\n.RE\n"; }

}  // namespace credence::cli::roff
