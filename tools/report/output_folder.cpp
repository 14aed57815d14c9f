#include "tools/report/output_folder.h"

#include <fstream>
#include <system_error>

#include "engine/core/digest.h"
#include "engine/core/error.h"
#include "sensor/output/apart.h"
#include "sensor/output/new_file.h"
#include "sensor/output/place.h"
#include "tools/report/swap_folder.h"

namespace patina {
namespace {

namespace fs = std::filesystem;

uint64_t digest_of_file(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    Digest digest;
    std::string block(size_t{1} << 20, '\0');
    while (file) {
        file.read(block.data(), static_cast<std::streamsize>(block.size()));
        digest.add(std::string_view(block).substr(0, static_cast<size_t>(file.gcount())));
    }
    return digest.value();
}

/// The first that is free, or holds results that are not whole either.
fs::path place_for_unfinished(const fs::path& place, ResultKind kind) {
    for (int i = 1; i <= sensor::kMostNumbered; ++i) {
        const fs::path other = sensor::numbered(place, "-unfinished", i);
        const EarlierResults found = results_in(other, kind);
        if (!sensor::is_taken(other) || (!found.finished && found.files.contains(mark_of(kind)))) return other;
    }
    return sensor::numbered(place, "-unfinished", sensor::kMostNumbered);  // refused later, and kept under another name
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& path, const std::vector<fs::path>& inputs, ResultKind kind)
    : path_(path), kind_(kind) {
    sensor::expect_apart(path, inputs);
    try {
        const fs::path place = sensor::resolved(path);
        expect_replaceable(place, kind);
        partial_.emplace(place);
        settle(place, kind);
        expect_replaceable(place, kind);  // with what has come back
    } catch (const std::exception& failure) {
        throw Error("output folder ", path, ": ", failure.what());
    }
}

void OutputFolder::write(const std::string& name, std::string_view bytes) {
    sensor::NewFile file(stage(name));
    file.write(bytes);
    file.close();
    publish(name);
}

fs::path OutputFolder::stage(const std::string& name) {
    PATINA_ASSERT(is_result_name(kind_, name), "not listed as the name of a result: ", name);
    const fs::path place = partial_->path() / name;
    std::error_code failure;
    fs::create_directories(place.parent_path(), failure);
    if (failure)
        throw Error("output folder ", path_, ": a folder for ", name,
                    " cannot be created: ", sensor::disk_reason(failure.value()));
    staged_.insert(name);
    return place;
}

void OutputFolder::publish(const std::string& name) {
    PATINA_ASSERT(staged_.contains(name), "published without being staged: ", name);
    const fs::path place = partial_->path() / name;
    if (!sensor::is_real_file(place)) throw Error("output folder ", path_, ": ", name, " was not written");
    digests_[name] = digest_of_file(place);
    staged_.erase(name);
}

void OutputFolder::discard_staged() {
    for (const std::string& name : staged_) {
        std::error_code ignored;
        fs::remove(partial_->path() / name, ignored);
    }
    staged_.clear();
}

void OutputFolder::withdraw(const std::string& beginning) {
    for (auto at = digests_.lower_bound(beginning); at != digests_.end() && at->first.starts_with(beginning);) {
        std::error_code ignored;
        fs::remove(partial_->path() / at->first, ignored);
        at = digests_.erase(at);
    }
}

fs::path OutputFolder::published(const std::string& name) const {
    PATINA_ASSERT(digests_.contains(name), "not published: ", name);
    return partial_->path() / name;
}

std::vector<std::string> OutputFolder::files() const {
    std::vector<std::string> names;
    for (const auto& [name, digest] : digests_) names.push_back(name);
    return names;
}

uint64_t OutputFolder::digest() const {
    Digest digest;
    for (const auto& [name, value] : digests_) {
        if (name == "report.html") continue;
        digest.add(name);
        digest.add(text(":", value, "\n"));
    }
    return digest.value();
}

void OutputFolder::commit() { put_in(partial_->target()); }

fs::path OutputFolder::commit_unfinished() {
    const fs::path target = partial_->target();
    const bool whole = results_in(target, kind_).finished;
    const fs::path place = whole ? place_for_unfinished(target, kind_) : target;
    put_in(place);
    return whole ? place : path_;
}

/// Results that cannot be put in place, of hours of work perhaps, are kept under another name.
void OutputFolder::put_in(const fs::path& place) {
    PATINA_ASSERT(staged_.empty(), "staged, but not published: ", *staged_.begin());
    try {
        sensor::flush_to_disk(partial_->path());
        settle(place, kind_);
        swap_in(*partial_, place, kind_);
    } catch (const std::exception& failure) {
        if (partial_->released()) throw;
        const fs::path kept = partial_->keep_beside(place);
        throw Error(reason_of(failure), "; the results are in '", kept.string(), "'");
    }
}

std::optional<fs::path> OutputFolder::keep() {
    discard_staged();
    if (digests_.empty()) return std::nullopt;
    return partial_->keep_beside(partial_->target());
}

}  // namespace patina
