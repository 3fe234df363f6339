#include "daemons/velodynelogger/PcapSequence.h"

namespace hermes::velodynelogger {

Outcome<void> PcapSequence::open(const std::vector<std::string> &paths) {
    paths_ = paths;
    file_ = 0;
    return reader_.open(paths_.at(0));
}

PcapReader::Next PcapSequence::next(Datagram &datagram) {
    for (;;) {
        const PcapReader::Next next = reader_.next(datagram);
        if (next != PcapReader::Next::End || file_ + 1 >= paths_.size())
            return next;
        if (!reader_.open(paths_[++file_]))
            return PcapReader::Next::Failed;
    }
}

Outcome<void> PcapSequence::seek(const Place &place) {
    if (place.file != file_)
        if (const Outcome<void> opened = reader_.open(paths_.at(place.file)); !opened)
            return opened;
    file_ = place.file;
    return reader_.seek(place.inFile);
}

} // namespace hermes::velodynelogger
