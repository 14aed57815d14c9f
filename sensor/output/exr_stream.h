#pragma once

#include <filesystem>

#include <OpenEXR/ImfIO.h>

#include "sensor/output/new_file.h"

namespace patina::sensor {

/// Lets OpenEXR write to a NewFile. Its functions throw Error as those of NewFile do.
class ExrStream : public Imf::OStream {
  public:
    explicit ExrStream(const std::filesystem::path& path) : Imf::OStream(path.c_str()), file_(path) {}

    void write(const char bytes[], int count) override { file_.write({bytes, static_cast<size_t>(count)}); }
    uint64_t tellp() override { return file_.position(); }
    void seekp(uint64_t position) override { file_.seek(position); }

    /// To be called once the Imf::OutputFile is gone.
    void close() { file_.close(); }

  private:
    NewFile file_;
};

}  // namespace patina::sensor
