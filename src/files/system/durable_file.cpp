#include "files/system/durable_file.hpp"

#include <credence/error.hpp>
#include <credence/store.hpp>

#include "files/system/byte_file.hpp"
#include "files/system/system_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace credence {

namespace {

const std::string suffix = ".credence-partial";

/// Renames the temporary file to its name, unless another file exists there than may be replaced. Returns 0 or an error
/// of the system.
int put_in_place(const std::string& aside, const Output& output) {
    const std::optional<FileIdentity> now = identity_of(output.target);
    if (now && output.there && now != output.there)
        fail_to_write(output.path, "another program changed or replaced it in the meantime", EEXIST);
    if (now && output.there) return rename(aside.c_str(), output.target.c_str()) == 0 ? 0 : errno;
    const int error = rename_to_free_name(aside, output.target);
    if (error == EEXIST) fail_to_write(output.path, "a file of that name appeared in the meantime", EEXIST);
    return error;
}

/// Writes aside and renames. The lock is held until after the renaming, so that no other program writes into the
/// finished file.
void write_and_rename(const Output& output, const std::function<int(int descriptor)>& write) {
    const std::string path = output.target + suffix;
    const Descriptor file = open_new_locked(path, output.path);
    int error = 0;
    try {
        take_owner_and_permissions(file, output.target);
        error = write(file.get());
        if (error == 0 && fsync(file.get()) != 0) error = errno;
        if (error == 0) error = put_in_place(path, output);
    } catch (...) {
        unlink(path.c_str());
        throw;
    }
    if (error == 0) return;
    unlink(path.c_str());
    fail_to_write(output.path, error);
}

[[noreturn]] void refuse(const std::string& path, const std::string& why, const std::string& remedy) {
    throw InputError("cannot write " + path + " (" + why + "). " + remedy + ".");
}

}  // namespace

std::optional<FileIdentity> identity_of(const std::string& path) {
    struct stat status {};
    if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
    return FileIdentity{status.st_dev, status.st_ino, status.st_size,
                        status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec};
}

// Renaming onto a link would replace the link.
Output::Output(const std::string& path) : path(path), target(followed(path).string()), there(identity_of(path)) {}

void write_durably(const Output& output, const std::function<int(int descriptor)>& write) {
    namespace fs = std::filesystem;
    std::error_code trouble;
    // Renaming onto a device would replace the device.
    const fs::file_status status = fs::symlink_status(output.target, trouble);
    if (fs::exists(status) && !fs::is_regular_file(status))
        fail_to_write(output.path, "there is something that is not a file", EEXIST);
    const FileSizeSignalIgnored ignored;
    write_and_rename(output, write);
    sync_folder(folder_of(output.target), output.path);
}

void write_text_file(const Output& output, const std::string& text) {
    write_durably(output, [&](int descriptor) {
        ByteFile bytes(descriptor);
        bytes.write(0, text.data(), text.size());
        return bytes.error();
    });
}

Output check_output(const std::string& path, bool overwrite, const std::string& way_out) {
    namespace fs = std::filesystem;
    Output output(path);
    const fs::path target(output.target), folder = folder_of(target);
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
    if (fs::is_symlink(target, trouble)) refuse(path, "its links lead in a circle", "Give another name");
    if (!fs::exists(status)) return output;
    if (!fs::is_regular_file(status)) refuse(path, "there is something that is not a file", "Give another name");
    if (!overwrite) refuse(path, "it is there already", way_out);
    return output;
}

}  // namespace credence
