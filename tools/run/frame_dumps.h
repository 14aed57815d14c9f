#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "engine/graph/state_visitor.h"
#include "export/write_exr.h"
#include "patina/frame.h"
#include "reconstruction/pipeline.h"
#include "tools/report/output_folder.h"
#include "tools/report/report.h"

namespace patina::tools {

/// The model as a dump's planes: colour and depth of the camera that looks; rgb is the re-rendering where there is one.
FrameDump to_dump(const ModelView& view);

/// Renders the model at some frames' colour cameras while a run goes on, and writes what arrives: frames/NNNNNN.exr and
/// previews/NNNNNN.png.
class FrameDumps {
  public:
    /// `dump_every`: EXR of every so many frames of the sequence, 0 for none. A few previews are spread over the
    /// `frames` frames.
    FrameDumps(OutputFolder& folder, std::optional<uint32_t> frames, uint32_t dump_every);

    /// To be called after each fused frame: asks for what this frame owes, and writes what has arrived.
    void after(Pipeline& pipeline, const SequenceInfo& info, const Frame& frame);

    /// Writes the rest; the device must have finished.
    void finish();

    /// Writes the rest before; what is brought back needs the files that were written by then.
    void visit(graph::StateVisitor& visitor);

    /// What could not be written, a sentence; empty where all was. Nothing more is written after that: a run goes on
    /// without its pictures.
    const std::string& problem() const { return problem_; }

    /// Writes the run's id into the EXR files written so far.
    void stamp(const std::string& run_id) const;

    /// The previews written so far, in order.
    const std::vector<ReportPicture>& previews() const { return previews_; }
    /// Of the same frames, what was recorded and what the model looked like.
    const std::vector<PicturePair>& pairs() const { return pairs_; }

  private:
    struct Owed {
        uint32_t index;
        ViewReadback view;
        bool dump;
        std::optional<ColorImage> preview_input;
    };
    void write(const Owed& owed);
    void write_files(const Owed& owed, const FrameDump& dump);

    OutputFolder& folder_;
    uint32_t dump_every_;
    std::deque<uint32_t> preview_at_;  ///< frame indices from which on the next preview is due
    std::deque<Owed> owed_;
    std::vector<ReportPicture> previews_;
    std::vector<PicturePair> pairs_;  ///< as many
    std::string problem_;
    std::vector<std::string> dumped_;  ///< names of the EXR files
};

}  // namespace patina::tools
