#include "durable_file.hpp"

#include <credence/error.hpp>
#include <credence/store.hpp>

#include "byte_file.hpp"
#include "system_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <climits>
#include <filesystem>
#include <system_error>

namespace credence {

namespace {

const std::string suffix = ".partial";

/// Writes aside and renames. The lock is held beyond the renaming, so that nobody writes into the finished file.
void write_and_rename(const std::string& target, const std::function<int(int descriptor)>& write) {
    const std::string path = target + suffix;
    const Descriptor file = open_locked(path, target);
    int error = ftruncate(file.get(), 0) == 0 ? 0 : errno;
    try {
        if (error == 0) error = write(file.get());
    } catch (...) {
        unlink(path.c_str());
        throw;
    }
    if (error == 0 && fsync(file.get()) != 0) error = errno;
    if (error == 0 && rename(path.c_str(), target.c_str()) != 0) error = errno;
    if (error == 0) return;
    unlink(path.c_str());
    fail_to_write(target, error);
}

[[noreturn]] void refuse(const std::string& path, const std::string& why, const std::string& remedy) {
    throw InputError("cannot write " + path + " (" + why + "). " + remedy + ".");
}

}  // namespace

void write_durably(const std::string& path, const std::function<int(int descriptor)>& write) {
    namespace fs = std::filesystem;
    std::error_code trouble;
    // Renaming onto a link would replace the link; onto a device, the device.
    const fs::path target = fs::is_symlink(path, trouble) ? fs::weakly_canonical(path, trouble) : fs::path(path);
    const fs::file_status status = fs::status(target, trouble);
    if (fs::exists(status) && !fs::is_regular_file(status))
        fail_to_write(path, "there is something that is not a file", EEXIST);
    const FileSizeSignalIgnored ignored;
    write_and_rename(target.string(), write);
    sync_folder(folder_of(target), path);
}

void write_text_file(const std::string& path, const std::string& text) {
    write_durably(path, [&](int descriptor) {
        ByteFile bytes(descriptor);
        bytes.write(0, text.data(), text.size());
        return bytes.error();
    });
}

void check_output(const std::string& path, bool overwrite, const std::string& way_out) {
    namespace fs = std::filesystem;
    const fs::path target(path), folder = folder_of(target);
    std::error_code trouble;
    if (target.filename().empty()) refuse(path, "it names no file", "Give the name of a file");
    if (target.filename().string().size() + suffix.size() > NAME_MAX)
        refuse(path, "the name is too long", "Give a shorter one");
    if (!fs::exists(folder, trouble)) refuse(path, "there is no folder " + folder.string(), "Make it first");
    if (!fs::is_directory(folder, trouble)) refuse(path, folder.string() + " is not a folder", "Give another place");
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        refuse(path, "its folder: " + words_for(errno), "Give a folder that you may write to");
    const fs::path aside = target.string() + suffix;
    if (const fs::file_status own = fs::symlink_status(aside, trouble); fs::exists(own) && !fs::is_regular_file(own))
        refuse(path, aside.filename().string() + " is in the way of writing it", "Remove that, or give another name");
    const fs::file_status status = fs::status(target, trouble);
    if (fs::is_symlink(target, trouble) && !fs::exists(status) && fs::weakly_canonical(target, trouble).empty())
        refuse(path, "it is a link that leads nowhere", "Give another name");
    if (!fs::exists(status)) return;
    if (!fs::is_regular_file(status)) refuse(path, "there is something that is not a file", "Give another name");
    if (!overwrite) refuse(path, "it is there already", way_out);
}

}  // namespace credence
