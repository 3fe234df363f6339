#include "daemons/seriallogger/SerialExport.h"

#include "common/files/SavedFile.h"
#include "common/ports/SerialLogReader.h"
#include "common/recording/DiskError.h"
#include "daemons/seriallogger/FixTracker.h"
#include "daemons/seriallogger/LineSplitter.h"
#include "daemons/seriallogger/SerialMessages.h"

#include <functional>

namespace hermes::seriallogger {

namespace {

std::string_view viewOf(const QByteArray &bytes) {
    return {bytes.constData(), std::size_t(bytes.size())};
}

/// Exactly, whatever the sign.
QByteArray seconds(std::int64_t ns) {
    const quint64 size = ns < 0 ? 0 - quint64(ns) : quint64(ns);
    return (ns < 0 ? "-" : "") + QByteArray::number(size / 1000000000) + '.' +
           QByteArray::number(size % 1000000000).rightJustified(9, '0');
}

QByteArray times(const Moment &arrival) {
    return seconds(arrival.stamp_ns) + ',' + seconds(arrival.mono_ns);
}

QByteArray quoted(QByteArray text) {
    return '"' + text.replace('"', "\"\"") + '"';
}

QByteArray cell(std::optional<double> value) {
    return value ? QByteArray::number(*value, 'g', 17) : QByteArray();
}

/// Makes the rows of one kind from pieces.
class RowMaker {
public:
    using Write = std::function<void(const QByteArray &row)>;

    RowMaker(ExportRows rows, nmea::ChecksumRule rule, Write write)
        : rows_(rows)
        , fixes_(rule)
        , write_(std::move(write)) {}

    QByteArray header() const {
        switch (rows_) {
        case ExportRows::Lines:
            return "stamp,mono,offset,text";
        case ExportRows::Bytes:
            return "stamp,mono,offset,bytes";
        case ExportRows::Fixes:
            break;
        }
        return "stamp,mono,time,valid,lat_deg,lon_deg,alt,quality,satellites,hdop,speed,course_deg";
    }

    void feed(const SerialLogReader::Piece &piece) {
        if (rows_ == ExportRows::Bytes)
            write_(times(piece.arrival) + ',' + QByteArray::number(piece.offset) + ',' + piece.bytes.toHex());
        else if (rows_ == ExportRows::Lines)
            lines_.feed(viewOf(piece.bytes), piece.arrival, lineSink());
        else
            fixes_.feed(viewOf(piece.bytes), piece.arrival, fixSink());
    }

    void finish() {
        lines_.finish(lineSink());
        fixes_.pause(fixSink());
    }

private:
    LineSplitter::Sink lineSink() {
        return [this](const LineSplitter::Line &line) {
            write_(times(line.arrival) + ',' + QByteArray::number(quint64(line.offset)) + ',' +
                   quoted(QByteArray::fromStdString(escaped(line.bytes))));
        };
    }
    FixTracker::Sink fixSink() {
        return [this](const Fix &fix) {
            const FixValues f = valuesOf(fix);
            QByteArray row = times(fix.arrival);
            for (const std::optional<double> &value : std::initializer_list<std::optional<double>>{
                     f.time, f.valid, f.lat_deg, f.lon_deg, f.alt, f.quality, f.satellites, f.hdop, f.speed,
                     f.course_deg})
                row += ',' + cell(value);
            write_(row);
        };
    }

    const ExportRows rows_;
    LineSplitter lines_;
    FixTracker fixes_;
    const Write write_;
};

} // namespace

Result<quint64> SerialExport::run(const std::atomic<bool> &cancel) const {
    SerialLogReader reader;
    if (const Result<void> opened = reader.open(base); !opened)
        return opened.error();
    SavedFile file(target);
    if (const Result<void> begun = file.begin(); !begun)
        return begun.error();
    quint64 count = 0;
    RowMaker maker(rows, checksum, [&](const QByteArray &row) {
        file.write(row + '\n');
        ++count;
    });
    file.write(maker.header() + '\n');
    for (;;) {
        const Result<SerialLogReader::Piece> piece = reader.next();
        if (!piece)
            return piece.error();
        if (piece->bytes.isEmpty())
            break;
        maker.feed(*piece);
        if (cancel)
            return Error(ErrorCode::NotReady, target + ": the logger ends, and the export with it");
        if (file.error() != QFileDevice::NoError)
            break;
    }
    maker.finish();
    if (const Result<void> done = file.commit(); !done)
        return done.error();
    return count;
}

} // namespace hermes::seriallogger
