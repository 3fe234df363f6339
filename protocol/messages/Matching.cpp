#include "protocol/messages/Matching.h"

#include "protocol/wire/Fields.h"

namespace hermes {

const Fields<PoseMessage> &fieldsOf(Of<PoseMessage>) {
    static const auto fields =
        Fields<PoseMessage>()
            .include(&PoseMessage::pose)
            .add("twist", &PoseMessage::twist, "Velocity in the sensor's frame")
            .mayBeMissing()
            .add("covariance", &PoseMessage::covariance,
                 "Of x, y and theta, row by row; null where the match leaves a direction open")
            .orNull()
            .add("outcome", &PoseMessage::outcome, "Of the scan; lost: the pose is the expected one")
            .choices({"matched", "lost", "skipped"})
            .add("scan", &PoseMessage::scan, "The turn it belongs to")
            .mayBeMissing()
            .add("trust", &PoseMessage::trust,
                 "How far to trust the pose, 0 to 1: how likely it is within 10 cm and 2 degrees of where "
                 "the map "
                 "shows the same")
            .mayBeMissing()
            .add("corrected", &PoseMessage::corrected,
                 "The map was corrected since the message before: the pose leapt, the robot did not")
            .mayBeMissing()
            .add("map_to_odometry", &PoseMessage::odometryFrame,
                 "Where the frame of the odometry lies in the map; null without odometry. What follows a "
                 "path by "
                 "the odometry and this stays smooth when the map is corrected")
            .orNull()
            .mayBeMissing();
    return fields;
}

const Fields<StepTimes> &fieldsOf(Of<StepTimes>) {
    static const auto fields = Fields<StepTimes>()
                                   .add("segment", &StepTimes::segment, "Segmentation", "ms")
                                   .add("vectorize", &StepTimes::vectorize, "Vectorization", "ms")
                                   .add("match", &StepTimes::match, "Matching", "ms")
                                   .add("map", &StepTimes::map, "Building the map", "ms");
    return fields;
}

const Fields<MatchMessage> &fieldsOf(Of<MatchMessage>) {
    static const auto fields =
        Fields<MatchMessage>()
            .add("scan", &MatchMessage::scan, "The turn it belongs to")
            .mayBeMissing()
            .add("accepted", &MatchMessage::accepted, "The pose was taken over")
            .mayBeMissing()
            .add("pairs", &MatchMessage::pairs, "Correspondences: id of the map's edge, index of the segment")
            .add("reliability", &MatchMessage::reliability, "0 to 1")
            .add("ambiguity", &MatchMessage::ambiguity, "Of the position", "m^2")
            .add("matched_length", &MatchMessage::matchedLength, "Of the segments in pairs", "m")
            .mayBeMissing()
            .add("visible_length", &MatchMessage::visibleLength, "Of all segments", "m")
            .mayBeMissing()
            .add("rms", &MatchMessage::rms, "Distance of the pairs", "m")
            .mayBeMissing()
            .add("ms", &MatchMessage::ms, "Time of each step")
            .mayBeMissing();
    return fields;
}

const Fields<ScanResult> &fieldsOf(Of<ScanResult>) {
    static const auto fields =
        Fields<ScanResult>()
            .add("stamp", &ScanResult::stamp, "Of the scan", "s")
            .add("pose", &ScanResult::pose, "As in the topic pose")
            .add("match", &ScanResult::match, "As in the topic match")
            .add("segments", &ScanResult::segments, "As in the topic segments: x1, y1, x2, y2 of each", "m");
    return fields;
}

} // namespace hermes
