#pragma once

#include "common/capture/PcapReader.h"

#include <vector>

namespace hermes::velodynelogger {

/// Reads capture files one after the other as if they were one, as a recording that went on in new files.
class PcapSequence {
public:
    /// Where a record begins.
    struct Place {
        std::size_t file = 0;
        PcapReader::Place inFile;
    };

    /// Opens the first; the others when it is their turn.
    Outcome<void> open(const std::vector<std::string> &paths);
    /// The payload stays valid until the next call.
    PcapReader::Next next(Datagram &datagram);
    void close() { reader_.close(); }

    /// Of the next record.
    Place place() const { return {file_, reader_.place()}; }
    /// Within this file: see PcapReader.
    bool canSeek() const { return reader_.canSeek(); }
    /// Goes on at a place that was told for the same files.
    Outcome<void> seek(const Place &place);
    const std::string &error() const { return reader_.error(); }
    /// Since the beginning; what was read twice is counted twice.
    PcapReader::Counts counts() const;

private:
    std::vector<std::string> paths_;
    std::size_t file_ = 0;
    PcapReader reader_;
    PcapReader::Counts before_; ///< of the files before this one
};

} // namespace hermes::velodynelogger
