#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "sensor/kinect2/color_assembler.h"
#include "sensor/kinect2/infrared_assembler.h"
#include "sensor/kinect2/raw_frame.h"

namespace patina::sensor::kinect2 {

/// Brings infrared and colour together by their time stamps, which are of one clock. A pair is at most 16 ms apart. The
/// streams' own frames are 33 ms apart, so that the first partner within 16 ms is the nearest. Colour comes some 60 ms
/// later than infrared of the same moment; frames wait for their partner, a few of each kind at most.
class FramePairer {
  public:
    /// Adds the next frame of a stream. One that repeats or precedes the last is kept, and finds no partner.
    void add(InfraredFrame frame);
    void add(ColorFrame frame);

    /// Exchanges the next pair with `pair`, whose buffers are reused. False: there is none yet.
    bool next(RawFrame& pair);

    /// A frame whose buffers can be filled.
    InfraredFrame spare_infrared();
    ColorFrame spare_color();

    uint64_t unpaired_infrared() const { return unpaired_infrared_; }
    uint64_t unpaired_color() const { return unpaired_color_; }

  private:
    void drop_infrared();
    void drop_color();

    std::deque<InfraredFrame> infrared_;
    std::deque<ColorFrame> color_;
    std::vector<InfraredFrame> spare_infrared_;
    std::vector<ColorFrame> spare_color_;
    uint64_t unpaired_infrared_ = 0, unpaired_color_ = 0;
};

}  // namespace patina::sensor::kinect2
