#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <streambuf>
#include <string>
#include <string_view>

namespace patina::sensor {

/// What a failure of the disk means to a person, from its errno: "no space is left on the disk".
std::string disk_reason(int error);

/// A file that is created, written and closed. What had its name before is replaced, not written into: of a link, or of
/// a file that has a second name, the other end stays as it was.
class NewFile {
  public:
    /// Throws Error when the file cannot be created, or its name is that of a folder, a device or the like.
    explicit NewFile(std::filesystem::path path);
    /// Closes the file; what close() did not write may be missing.
    ~NewFile();
    NewFile(const NewFile&) = delete;
    NewFile& operator=(const NewFile&) = delete;

    /// Appends bytes at the position, which moves behind them. Throws Error, naming the file, how many bytes were to be
    /// written and why they could not.
    void write(std::string_view bytes);

    uint64_t position() const { return position_; }
    /// From the file's start, in bytes. Throws Error as write().
    void seek(uint64_t position);

    /// Writes what is buffered and closes the file. Throws Error as write().
    void close();

  private:
    void flush();

    std::filesystem::path path_;
    int file_ = -1;
    uint64_t position_ = 0;
    std::string buffer_;  ///< what lies before position_ and is not written yet
};

/// Lets libraries that write to a stream write to a NewFile.
class NewFileStream : public std::streambuf {
  public:
    explicit NewFileStream(NewFile& file) : file_(file) {}

    /// Throws the Error of the first write that failed; a stream only says that one did.
    void expect_written() const;

  protected:
    int_type overflow(int_type character) override;
    std::streamsize xsputn(const char* bytes, std::streamsize count) override;

  private:
    NewFile& file_;
    std::exception_ptr failure_;
};

}  // namespace patina::sensor
