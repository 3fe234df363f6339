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

std::string PcapFiles::open(const RecordingPlan &plan) {
    writer_.close();
    plan_ = plan;
    files_.clear();
    return next();
}

std::string PcapFiles::next() {
    if (writer_.isOpen() && !writer_.close())
        return writer_.error();
    note();
    const std::string path = pathOf(files_.size() + 1);
    if (!writer_.open(path))
        return writer_.error();
    files_.push_back({path.substr(path.rfind('/') + 1)});
    opened_ = std::chrono::steady_clock::now();
    note();
    return {};
}

std::string PcapFiles::write(const Datagram &datagram) {
    const bool full = double(writer_.bytes() + overhead + datagram.size) > plan_.fileBytes;
    const std::chrono::duration<double> age = std::chrono::steady_clock::now() - opened_;
    if (writer_.packets() > 0 && (full || age.count() >= plan_.fileSeconds)) {
        const std::string error = next();
        if (!error.empty())
            return error;
    }
    if (!writer_.write(datagram)) {
        note();
        return writer_.error();
    }
    File &file = files_.back();
    file.first_ns = file.first_ns ? file.first_ns : datagram.stamp_ns;
    file.last_ns = datagram.stamp_ns;
    return {};
}

std::string PcapFiles::flush() {
    const bool done = writer_.flush();
    note();
    return done ? std::string() : writer_.error();
}

std::string PcapFiles::close() {
    const bool done = writer_.close();
    note();
    return done ? std::string() : writer_.error();
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
