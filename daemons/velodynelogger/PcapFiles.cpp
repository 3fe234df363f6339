#include "daemons/velodynelogger/PcapFiles.h"

namespace hermes::velodynelogger {

namespace {

constexpr std::size_t overhead = 42 + PcapWriter::recordHeaderBytes; // of a datagram in a file

} // namespace

std::string PcapFiles::pathOf(std::size_t number) const {
    return QString("%1/%2-%3.pcap")
        .arg(plan_.folder, plan_.prefix)
        .arg(qulonglong(number), 4, 10, QChar('0'))
        .toStdString();
}

Outcome<void> PcapFiles::open(const RecordingPlan &plan) {
    writer_.close(); // of what is left of a recording that failed
    plan_ = plan;
    files_.clear();
    return next();
}

Outcome<void> PcapFiles::next() {
    if (writer_.isOpen())
        if (const Outcome<void> closed = writer_.close(); !closed)
            return closed;
    note();
    const std::string path = pathOf(std::size_t(plan_.earlierFiles()) + files_.size() + 1);
    if (const Outcome<void> opened = writer_.open(path); !opened)
        return opened;
    files_.push_back({path.substr(path.rfind('/') + 1)});
    opened_ = std::chrono::steady_clock::now();
    note();
    return {};
}

Outcome<void> PcapFiles::write(const Datagram &datagram) {
    const bool full = double(writer_.bytes() + overhead + datagram.size) > plan_.fileBytes;
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - opened_;
    if (writer_.packets() > 0 && (full || age.count() >= plan_.fileSeconds)) {
        if (const Outcome<void> begun = next(); !begun)
            return begun;
    }
    if (const Outcome<void> written = writer_.write(datagram); !written) {
        note();
        return written;
    }
    File &file = files_.back();
    file.first_ns = file.first_ns ? file.first_ns : datagram.stamp_ns;
    file.last_ns = datagram.stamp_ns;
    return {};
}

Outcome<void> PcapFiles::flush() {
    const Outcome<void> flushed = writer_.flush();
    note();
    return flushed;
}

Outcome<void> PcapFiles::close() {
    const Outcome<void> closed = writer_.close();
    note();
    return closed;
}

void PcapFiles::note() {
    if (files_.empty())
        return;
    files_.back().bytes = writer_.writtenBytes();
    files_.back().packets = writer_.writtenPackets();
}

QJsonArray toJson(const std::vector<PcapFiles::File> &files) {
    QJsonArray list;
    for (const PcapFiles::File &file : files)
        list.append(QJsonObject{{"name", QString::fromStdString(file.name)},
                                {"bytes", double(file.bytes)},
                                {"packets", double(file.packets)},
                                {"start", double(file.first_ns) * 1e-9},
                                {"end", double(file.last_ns) * 1e-9}});
    return list;
}

} // namespace hermes::velodynelogger
