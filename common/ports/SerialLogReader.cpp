#include "common/ports/SerialLogReader.h"

#include "common/files/NamedFile.h"
#include "common/recording/DiskError.h"

#include <QFileInfo>

#include <algorithm>

namespace hermes {

using namespace serialindex;

Result<void> SerialLogReader::open(const QString &base) {
    index_.setFileName(base + ".index");
    raw_.setFileName(base + ".raw");
    for (QFile *file : {&index_, &raw_}) {
        const Result<QString> found = findNamedFile(file->fileName(), {QFileInfo(base).path()}, 0);
        if (!found)
            return found.error();
        if (!file->open(QIODevice::ReadOnly))
            return diskError(file->fileName() + ": cannot be read: " + file->errorString(), file->fileName());
    }
    if (index_.read(headerSize) !=
        QByteArray(reinterpret_cast<const char *>(header.data()), int(header.size())))
        return wrong("\"HERMESIX\" version 1 expected at its beginning");
    offset_ = end_ = 0;
    size_ = quint64(raw_.size()); // before the index is read, which grows first
    chunk_.reset();
    following_ = readRecord();
    if (size_ > 0 && (!following_ || following_->offset != 0))
        return wrong("expected a first record, at byte 0");
    return {};
}

Result<SerialLogReader::Piece> SerialLogReader::next() {
    if (offset_ == end_) {
        if (!following_ || following_->offset >= size_)
            return Piece();
        chunk_ = following_;
        following_ = readRecord();
        if (following_ && following_->offset <= chunk_->offset)
            return wrong(QString("a record at byte %1 follows one at byte %2")
                             .arg(following_->offset)
                             .arg(chunk_->offset));
        end_ = following_ ? std::min<quint64>(following_->offset, size_) : size_;
    }
    Piece piece{offset_, chunk_->arrival, raw_.read(std::min(maxBytes, qint64(end_ - offset_)))};
    if (piece.bytes.isEmpty())
        return diskError(raw_.fileName() + ": cannot be read: " + raw_.errorString(), raw_.fileName());
    offset_ += quint64(piece.bytes.size());
    return piece;
}

Result<void> SerialLogReader::seek(std::int64_t mono_ns) {
    const auto goTo = [this](qint64 number) {
        return index_.seek(qint64(headerSize) + number * qint64(recordSize));
    };
    qint64 first = 0, last = (index_.size() - qint64(headerSize)) / qint64(recordSize);
    while (first < last) {
        const qint64 middle = (first + last) / 2;
        const std::optional<Record> record = goTo(middle) ? readRecord() : std::nullopt;
        if (!record)
            return wrong("cannot be read: " + index_.errorString());
        if (record->arrival.mono_ns < mono_ns)
            first = middle + 1;
        else
            last = middle;
    }
    following_ = goTo(first) ? readRecord() : std::nullopt;
    offset_ = end_ = following_ ? std::min<quint64>(following_->offset, size_) : size_;
    if (!raw_.seek(qint64(offset_)))
        return diskError(raw_.fileName() + ": cannot be read: " + raw_.errorString(), raw_.fileName());
    return {};
}

std::optional<Record> SerialLogReader::readRecord() {
    unsigned char bytes[recordSize];
    if (index_.read(reinterpret_cast<char *>(bytes), recordSize) != qint64(recordSize))
        return std::nullopt;
    return decode(bytes);
}

Error SerialLogReader::wrong(const QString &what) const {
    return diskError(index_.fileName() + ": " + what, index_.fileName());
}

} // namespace hermes
