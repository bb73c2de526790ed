#pragma once
// Module base: the two kinds of error of credence. Numerical trouble inside a trial is neither: it is data
// (columns.hpp).

#include <stdexcept>
#include <string>

namespace credence {

/// The input cannot be used: nothing has been computed or written. The program exits with 2. The message reads
/// `invalid NAME=VALUE (WHY). REMEDY.` or `cannot DO SOMETHING (WHY). REMEDY.`, on one line [CONTRIBUTING.md, Errors].
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& message, std::string key = {})
        : std::runtime_error(message), key_(std::move(key)) {}
    /// The scenario key that the message is about, so that the reader of a file can add its line; empty for none.
    const std::string& key() const { return key_; }

private:
    std::string key_;
};

/// The work itself failed (no space, a replay that differs, a requirement not met). The program exits with 1.
class Failure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Text from outside the program, made fit for a message of one line: control characters are escaped, such as `\n` or
/// `\u001b` [text.hpp, shown], and a long text is cut.
std::string printable(const std::string& given, std::size_t longest = 100);

/// `invalid NAME=VALUE (WHY). REMEDY`: the format of the message for every refused value.
inline InputError invalid_value(const std::string& name, const std::string& value, const std::string& why,
                                const std::string& remedy) {
    return InputError(
        "invalid " + printable(name) + "=" + printable(value) + " (" + printable(why) + "). " + remedy + ".", name);
}

}  // namespace credence
