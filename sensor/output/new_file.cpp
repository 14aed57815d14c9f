#include "sensor/output/new_file.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/error.h"

namespace patina::sensor {
namespace {

constexpr size_t kBuffer = size_t{1} << 20;

[[noreturn]] void fail(const std::filesystem::path& path, size_t bytes, int error) {
    throw Error(path.string(), " cannot be written: ", bytes, " bytes were refused: ", disk_reason(error));
}

}  // namespace

std::string disk_reason(int error) {
    switch (error) {
        case ENOSPC: return "no space is left on the disk";
        case EDQUOT: return "the user's share of the disk is used up";
        case EFBIG: return "the file would be larger than files may be here";
        case EROFS: return "the disk is read-only";
        default: return std::generic_category().message(error);
    }
}

NewFile::NewFile(std::filesystem::path path) : path_(std::move(path)) {
    struct stat status {};
    if (lstat(path_.c_str(), &status) == 0) {
        const bool replaced = S_ISREG(status.st_mode) || S_ISLNK(status.st_mode);
        if (!replaced) throw Error(path_.string(), " cannot be written: it is a folder, a device or the like");
        if (unlink(path_.c_str()) != 0) throw Error(path_.string(), " cannot be written: ", disk_reason(errno));
    }
    file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file_ < 0) throw Error(path_.string(), " cannot be written: ", disk_reason(errno));
}

NewFile::~NewFile() {
    if (file_ >= 0) ::close(file_);
}

void NewFile::write(std::string_view bytes) {
    buffer_.append(bytes);
    position_ += bytes.size();
    if (buffer_.size() >= kBuffer) flush();
}

void NewFile::seek(uint64_t position) {
    flush();
    if (lseek(file_, static_cast<off_t>(position), SEEK_SET) < 0) fail(path_, 0, errno);
    position_ = position;
}

void NewFile::flush() {
    for (size_t done = 0; done < buffer_.size();) {
        const ssize_t written = ::write(file_, buffer_.data() + done, buffer_.size() - done);
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) fail(path_, buffer_.size() - done, written < 0 ? errno : EIO);
        done += static_cast<size_t>(written);
    }
    buffer_.clear();
}

void NewFile::close() {
    flush();
    if (::close(std::exchange(file_, -1)) != 0 && errno != EINTR) fail(path_, position_, errno);
}

void NewFileStream::expect_written() const {
    if (failure_) std::rethrow_exception(failure_);
}

NewFileStream::int_type NewFileStream::overflow(int_type character) {
    if (traits_type::eq_int_type(character, traits_type::eof())) return traits_type::not_eof(character);
    const char byte = traits_type::to_char_type(character);
    return xsputn(&byte, 1) == 1 ? character : traits_type::eof();
}

std::streamsize NewFileStream::xsputn(const char* bytes, std::streamsize count) {
    if (failure_) return 0;
    try {
        file_.write({bytes, static_cast<size_t>(count)});
        return count;
    } catch (...) {
        failure_ = std::current_exception();  // a stream must not throw into a library
        return 0;
    }
}

}  // namespace patina::sensor
