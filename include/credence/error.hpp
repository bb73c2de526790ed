#pragma once
// Module base: the two kinds of error of credence. Numerical trouble inside a trial is neither: it is data
// (columns.hpp).

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace credence {

/// Text from outside the program, made fit for a message of one line: control characters are escaped, such as `\n` or
/// `\u001b` [text.hpp, shown], and a long text is cut.
std::string printable(const std::string& given, std::size_t longest = 100);

/// What is wrong, why, and what to do about it. Its text is `PLACE: SUBJECT (REASON). REMEDY.`, or
/// `PLACE: invalid SUBJECT=VALUE (REASON). REMEDY.` [CONTRIBUTING.md, Errors].
struct Complaint {
    std::string subject;  ///< the name of a refused value, or a whole such as `cannot write a.h5`
    std::string reason{};                ///< why; may be empty
    std::string remedy{};                ///< what the user can do, with or without its full stop; may be empty
    std::optional<std::string> value{};  ///< of a refused value
    std::string place{};                 ///< where it is, such as `study.ini:3`; may be empty

    std::string text() const;
};

/// An error whose message is the text of its complaint.
class ComplaintError : public std::runtime_error {
public:
    explicit ComplaintError(Complaint complaint)
        : std::runtime_error(complaint.text()), complaint_(std::move(complaint)) {}
    /// `SUBJECT (REASON). REMEDY.`
    explicit ComplaintError(const std::string& subject, const std::string& reason = {}, const std::string& remedy = {})
        : ComplaintError(Complaint{subject, reason, remedy}) {}
    const Complaint& complaint() const { return complaint_; }

private:
    Complaint complaint_;
};

/// The input cannot be used: nothing has been computed or written. The program exits with 2.
class InputError : public ComplaintError {
public:
    using ComplaintError::ComplaintError;
    /// The same at a place, which comes before the place that it has.
    InputError at(const std::string& place) const {
        Complaint there = complaint();
        there.place = there.place.empty() ? place : place + ": " + there.place;
        return InputError(there);
    }
};

/// The work itself failed (no space, a replay that differs, a requirement not met). The program exits with 1.
class Failure : public ComplaintError {
public:
    using ComplaintError::ComplaintError;
};

/// The refusal of a value.
inline InputError invalid_value(const std::string& name, const std::string& value, const std::string& why,
                                const std::string& remedy) {
    return InputError(Complaint{name, why, remedy, value});
}

/// What `work` returns; its InputErrors are thrown again at a place.
template <class Work>
auto at_place(const std::string& place, const Work& work) {
    try {
        return work();
    } catch (const InputError& error) {
        throw error.at(place);
    }
}

}  // namespace credence
