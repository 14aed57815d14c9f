#include "engine/core/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/error.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

std::string reason(int error) { return std::generic_category().message(error); }

/// Closes a file descriptor at the end of its scope.
class OpenFile {
  public:
    explicit OpenFile(const fs::path& file) : number_(::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile() {
        if (number_ >= 0) ::close(number_);
    }

    int number() const { return number_; }

  private:
    int number_;
};

const char* kind_of(const struct stat& status) {
    if (S_ISDIR(status.st_mode)) return "a folder";
    if (S_ISFIFO(status.st_mode)) return "a pipe";
    if (S_ISSOCK(status.st_mode)) return "a socket";
    return "a device";
}

void expect_regular(const fs::path& file, const struct stat& status) {
    if (!S_ISREG(status.st_mode)) throw Error(file.string(), " is ", kind_of(status), ", not a file");
}

[[noreturn]] void fail_to_read(const fs::path& file, int error) {
    if (error == ENOENT || error == ENOTDIR) throw Error(file.string(), " does not exist");
    throw Error(file.string(), " cannot be read: ", reason(error));
}

fs::file_status status_of(const fs::path& path) {
    std::error_code failure;
    const fs::file_status status = fs::status(path, failure);
    if (status.type() == fs::file_type::none) throw Error(path.string(), " cannot be read: ", failure.message());
    return status;
}

/// Reads until `bytes` is full or the file ends, and cuts `bytes` there.
void fill(const fs::path& file, int number, std::vector<uint8_t>& bytes) {
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got = ::read(number, bytes.data() + done, bytes.size() - done);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail_to_read(file, errno);
        if (got == 0) break;
        done += static_cast<size_t>(got);
    }
    bytes.resize(done);
}

}  // namespace

bool path_exists(const fs::path& path) { return fs::exists(status_of(path)); }

bool is_folder(const fs::path& path) { return fs::is_directory(status_of(path)); }

std::vector<fs::path> entries_of(const fs::path& folder) {
    std::vector<fs::path> entries;
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
        entries.push_back(entry->path());
    if (failure) throw Error(folder.string(), " cannot be read: ", failure.message());
    std::sort(entries.begin(), entries.end());
    return entries;
}

void expect_file(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) fail_to_read(file, errno);
    expect_regular(file, status);
}

std::vector<uint8_t> read_file(const fs::path& file, uint64_t most_bytes) {
    expect_file(file);  // by name first: to open a device can change it
    const OpenFile open(file);
    if (open.number() < 0) fail_to_read(file, errno);
    struct stat status {};
    if (::fstat(open.number(), &status) != 0) fail_to_read(file, errno);
    expect_regular(file, status);
    const auto size = static_cast<uint64_t>(status.st_size);
    if (size > most_bytes) throw Error(file.string(), " has ", size, " bytes, at most ", most_bytes, " are read");
    std::vector<uint8_t> bytes(size);
    fill(file, open.number(), bytes);
    return bytes;
}

void check_picture_size(const std::string& file, uint64_t width, uint64_t height) {
    if (width == 0 || height == 0) throw Error(file, " is ", width, " x ", height, " pixels, which is no picture");
    if (width <= limits::kPicturePixels / height) return;
    throw Error(file, " is ", width, " x ", height, " pixels, at most ", limits::kPicturePixels, " are decoded");
}

void check_json_depth(const std::string& file, std::span<const uint8_t> json) {
    size_t depth = 0;
    bool in_string = false;
    for (size_t i = 0; i < json.size(); ++i) {
        const uint8_t byte = json[i];
        if (in_string) {
            if (byte == '\\') ++i;
            if (byte == '"') in_string = false;
        } else if (byte == '"') {
            in_string = true;
        } else if (byte == '[' || byte == '{') {
            if (++depth > limits::kJsonDepth) {
                throw Error(file, " nests deeper than ", limits::kJsonDepth, " levels at byte ", i,
                            ", more are not read");
            }
        } else if ((byte == ']' || byte == '}') && depth > 0) {
            --depth;
        }
    }
}

}  // namespace patina
