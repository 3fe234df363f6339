#pragma once

#include "common/capture/PcapWriter.h"
#include "common/recording/RecordingWriter.h"

#include <chrono>

namespace hermes::velodynelogger {

/// The capture files of one recording: goes on in a new one where one gets too long or too old, always with a
/// whole datagram. Not for several threads at once.
class PcapFiles {
public:
    struct File {
        std::string name;
        std::uint64_t bytes = 0;   ///< written, with the header of the file
        std::uint64_t packets = 0; ///< written
        std::int64_t first_ns = 0; ///< stamps of its first and last datagram
        std::int64_t last_ns = 0;
    };

    Outcome<void> open(const RecordingPlan &plan);
    Outcome<void> write(const Datagram &datagram);
    /// What was written is the system's from here on: it outlives this process.
    Outcome<void> flush();
    /// Ends the last file. Keeps files().
    Outcome<void> close();

    const std::vector<File> &files() const { return files_; }
    std::string path() const {
        return pathOf(std::size_t(plan_.earlierFiles()) + files_.size());
    } ///< of the last

private:
    Outcome<void> next();
    std::string pathOf(std::size_t number) const;
    void note();

    RecordingPlan plan_;
    PcapWriter writer_;
    std::vector<File> files_;
    std::chrono::steady_clock::time_point opened_;
};

QJsonArray toJson(const std::vector<PcapFiles::File> &files);

} // namespace hermes::velodynelogger
