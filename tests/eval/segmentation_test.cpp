#include "tools/eval/segmentation.h"

#include <vector>

#include <gtest/gtest.h>

namespace patina::eval::segmentation_test {
namespace {

TEST(Segmentation, OneLabelPerObjectIsPerfect) {
    LabelOverlap overlap;
    overlap.add(1, 40, 1000);
    overlap.add(2, 7, 500);
    for (const uint32_t object : {1u, 2u}) {
        const ObjectSegmentation result = overlap.segmentation_of(object);
        EXPECT_EQ(result.best_label, object == 1 ? 40u : 7u);
        EXPECT_EQ(result.iou, 1);
        EXPECT_EQ(result.best_label_share, 1);
        EXPECT_EQ(result.labels, 1u);
        EXPECT_EQ(result.foreign_share, 0);
    }
}

TEST(Segmentation, ASplitObjectIsOverSegmented) {
    LabelOverlap overlap;
    overlap.add(1, 10, 600);
    overlap.add(1, 11, 350);
    overlap.add(1, 12, 50);  // exactly 5 %
    const ObjectSegmentation result = overlap.segmentation_of(1);
    EXPECT_EQ(result.best_label, 10u);
    EXPECT_DOUBLE_EQ(result.iou, 0.6);
    EXPECT_DOUBLE_EQ(result.best_label_share, 0.6);
    EXPECT_EQ(result.labels, 3u);
    EXPECT_EQ(result.foreign_share, 0);
}

TEST(Segmentation, LabelsOnLessThanFivePercentAreNotCounted) {
    LabelOverlap overlap;
    overlap.add(1, 10, 951);
    overlap.add(1, 11, 49);
    EXPECT_EQ(overlap.segmentation_of(1).labels, 1u);
}

TEST(Segmentation, MergedObjectsAreUnderSegmented) {
    LabelOverlap overlap;
    overlap.add(1, 10, 300);
    overlap.add(2, 10, 600);
    overlap.add(0, 10, 100);
    const ObjectSegmentation result = overlap.segmentation_of(1);
    EXPECT_DOUBLE_EQ(result.iou, 0.3);
    EXPECT_EQ(result.best_label_share, 1);
    EXPECT_DOUBLE_EQ(result.foreign_share, 0.6);  // the background is no other object
}

TEST(Segmentation, TheBestLabelIsThatOfLargestIouNotOfLargestOverlap) {
    LabelOverlap overlap;
    overlap.add(1, 10, 550);  // a label that also covers a far larger object
    overlap.add(2, 10, 9000);
    overlap.add(1, 11, 450);
    EXPECT_EQ(overlap.segmentation_of(1).best_label, 11u);
    EXPECT_DOUBLE_EQ(overlap.segmentation_of(1).iou, 0.45);
}

TEST(Segmentation, UnlabelledPixelsBelongToTheObjectButToNoLabel) {
    LabelOverlap overlap;
    overlap.add(1, 0, 250);
    overlap.add(1, 10, 750);
    overlap.add(2, 0, 99);
    EXPECT_DOUBLE_EQ(overlap.segmentation_of(1).iou, 0.75);
    const ObjectSegmentation unlabelled = overlap.segmentation_of(2);
    EXPECT_FALSE(unlabelled.best_label);
    EXPECT_EQ(unlabelled.iou, 0);
    EXPECT_EQ(unlabelled.labels, 0u);
}

TEST(Segmentation, FramesArePooled) {
    LabelOverlap first, second;
    first.add(1, 10, 100);
    second.add(1, 10, 100);
    second.add(1, 11, 200);
    first.add(second);
    EXPECT_DOUBLE_EQ(first.segmentation_of(1).iou, 0.5);
    EXPECT_EQ(first.segmentation_of(1).labels, 2u);
}

TEST(Segmentation, AveragesOverObjects) {
    const SegmentationResult mean =
        mean_of(std::vector<ObjectSegmentation>{{10, 1.0, 1.0, 1, 0.0}, {11, 0.5, 0.6, 4, 0.2}});
    EXPECT_DOUBLE_EQ(mean.iou, 0.75);
    EXPECT_DOUBLE_EQ(mean.best_label_share, 0.8);
    EXPECT_DOUBLE_EQ(mean.labels, 2.5);
    EXPECT_DOUBLE_EQ(mean.foreign_share, 0.1);
}

}  // namespace
}  // namespace patina::eval::segmentation_test
