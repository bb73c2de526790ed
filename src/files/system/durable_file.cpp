#include "files/system/durable_file.hpp"

#include <credence/error.hpp>

#include "files/system/byte_file.hpp"
#include "files/system/system_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

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
    throw InputError("cannot write " + path, why, remedy);
}

}  // namespace

void check_not_read(const Output& output, const std::vector<std::string>& inputs) {
    for (const std::string& input : inputs)
        if (same_file(input, output.target) || same_file(input, output.target + suffix))
            refuse(output.path, "it would replace " + input + ", which is read", "Give another name");
}

std::optional<FileIdentity> identity_of(const std::string& path) {
    const std::optional<struct stat> status = status_of(path, path);
    if (!status || !S_ISREG(status->st_mode)) return std::nullopt;
    return FileIdentity{status->st_dev, status->st_ino, status->st_size,
                        status->st_mtim.tv_sec * std::int64_t{1'000'000'000} + status->st_mtim.tv_nsec};
}

// Renaming onto a link would replace the link.
Output::Output(const std::string& path) : path(path), target(followed(path).string()), there(identity_of(path)) {}

void write_durably(const Output& output, const std::function<int(int descriptor)>& write) {
    // Renaming onto a device would replace the device.
    const std::optional<struct stat> status = status_of(output.target, output.path, Links::themselves);
    if (status && !S_ISREG(status->st_mode))
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
    Output output(path);
    const std::filesystem::path target(output.target), folder = folder_of(target);
    if (target.filename().empty()) refuse(path, "it names no file", "Give the name of a file");
    if (target.filename().string().size() + suffix.size() > NAME_MAX)
        refuse(path, "the name is too long", "Give a shorter one");
    const std::optional<struct stat> of_folder = status_of(folder, path);
    if (!of_folder) refuse(path, "there is no folder " + folder.string(), "Make it first");
    if (!S_ISDIR(of_folder->st_mode)) refuse(path, folder.string() + " is not a folder", "Give another place");
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        refuse(path, "its folder: " + words_for(errno), "Give a folder that you may write to");
    const std::filesystem::path aside = target.string() + suffix;
    if (const auto own = status_of(aside, path, Links::themselves); own && !S_ISREG(own->st_mode))
        refuse(path, aside.filename().string() + " is in the way of writing it", "Remove that, or give another name");
    const std::optional<struct stat> there = status_of(target, path, Links::themselves);
    if (!there) return output;
    if (S_ISLNK(there->st_mode)) refuse(path, "its links lead in a circle", "Give another name");
    if (!S_ISREG(there->st_mode)) refuse(path, "there is something that is not a file", "Give another name");
    if (!overwrite) refuse(path, "it is there already", way_out);
    return output;
}

}  // namespace credence
