#include "tools/report/run_id.h"

#include <array>
#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

#include "engine/core/error.h"
#include "sensor/output/new_file.h"
#include "sensor/output/partial_folder.h"

namespace patina {
namespace {

constexpr size_t kMostHeader = size_t{1} << 16;  // bytes; that of a run's pictures has some 2000

/// An attribute as OpenEXR writes it: name, type and length of the value, then the value.
std::string pending_attribute() {
    using namespace std::string_literals;
    const char length = static_cast<char>(kRunIdPending.size());
    return std::string(kRunIdAttribute) + "\0string\0"s + length + "\0\0\0"s + kRunIdPending;
}

}  // namespace

void stamp_run_id(const std::filesystem::path& exr, const std::string& id) {
    PATINA_ASSERT(id.size() == kRunIdPending.size(), id);
    const sensor::OpenFile file(open(exr.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC));
    std::string header(kMostHeader, '\0');
    const ssize_t count = file ? pread(file.get(), header.data(), header.size(), 0) : -1;
    if (count < 0) throw Error(exr.string(), " cannot be read: ", sensor::disk_reason(errno));
    header.resize(static_cast<size_t>(count));
    const std::string attribute = pending_attribute();
    const size_t at = header.find(attribute);
    if (at == std::string::npos) throw Error(exr.string(), " has no place for the run's id");
    const off_t place = static_cast<off_t>(at + attribute.size() - id.size());
    if (pwrite(file.get(), id.data(), id.size(), place) != static_cast<ssize_t>(id.size()))
        throw Error(exr.string(), " cannot be written: ", sensor::disk_reason(errno));
}

}  // namespace patina
