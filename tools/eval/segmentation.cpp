#include "tools/eval/segmentation.h"

namespace patina::eval {

void LabelOverlap::add(const LabelOverlap& other) {
    for (const auto& [pair, pixels] : other.pixels_) pixels_[pair] += pixels;
}

std::map<uint32_t, LabelOverlap::Label> LabelOverlap::labels_on(uint32_t object) const {
    std::map<uint32_t, Label> labels;
    for (auto it = pixels_.lower_bound({object, 1}); it != pixels_.end() && it->first.first == object; ++it) {
        labels[it->first.second].inside = it->second;
    }
    for (const auto& [pair, pixels] : pixels_) {
        const auto label = labels.find(pair.second);
        if (label == labels.end()) continue;
        label->second.total += pixels;
        if (pair.first != object && pair.first != 0) label->second.foreign += pixels;
    }
    return labels;
}

uint64_t LabelOverlap::pixels_of(uint32_t object) const {
    uint64_t sum = 0;
    for (const auto& [pair, pixels] : pixels_) sum += pair.first == object ? pixels : 0;
    return sum;
}

ObjectSegmentation LabelOverlap::segmentation_of(uint32_t object) const {
    const auto object_pixels = static_cast<double>(pixels_of(object));
    ObjectSegmentation result;
    for (const auto& [id, label] : labels_on(object)) {
        const auto inside = static_cast<double>(label.inside), total = static_cast<double>(label.total);
        if (inside >= kLabelShare * object_pixels) ++result.labels;
        const double iou = inside / (object_pixels + total - inside);
        if (iou <= result.iou) continue;
        result.best_label = id;
        result.iou = iou;
        result.best_label_share = inside / object_pixels;
        result.foreign_share = static_cast<double>(label.foreign) / total;
    }
    return result;
}

SegmentationResult mean_of(std::span<const ObjectSegmentation> objects) {
    SegmentationResult mean;
    for (const ObjectSegmentation& object : objects) {
        mean.iou += object.iou;
        mean.best_label_share += object.best_label_share;
        mean.labels += object.labels;
        mean.foreign_share += object.foreign_share;
    }
    const auto count = static_cast<double>(objects.size());
    return {mean.iou / count, mean.best_label_share / count, mean.labels / count, mean.foreign_share / count};
}

}  // namespace patina::eval
