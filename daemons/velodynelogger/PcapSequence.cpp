#include "daemons/velodynelogger/PcapSequence.h"

namespace hermes::velodynelogger {

Outcome<void> PcapSequence::open(const std::vector<std::string> &paths) {
    paths_ = paths;
    file_ = 0;
    before_ = PcapReader::Counts();
    return reader_.open(paths_.at(0));
}

PcapReader::Next PcapSequence::next(Datagram &datagram) {
    for (;;) {
        const PcapReader::Next next = reader_.next(datagram);
        if (next != PcapReader::Next::End || file_ + 1 >= paths_.size())
            return next;
        before_ += reader_.counts();
        if (!reader_.open(paths_[++file_]))
            return PcapReader::Next::Failed;
    }
}

PcapReader::Counts PcapSequence::counts() const {
    PcapReader::Counts counts = before_;
    return counts += reader_.counts();
}

Outcome<void> PcapSequence::seek(const Place &place) {
    if (place.file != file_)
        if (const Outcome<void> opened = reader_.open(paths_.at(place.file)); !opened)
            return opened;
    file_ = place.file;
    return reader_.seek(place.inFile);
}

} // namespace hermes::velodynelogger
