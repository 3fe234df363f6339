#include "common/recording/Sidecar.h"
#include "daemons/seriallogger/SerialExport.h"
#include "daemons/seriallogger/SerialLogReader.h"
#include "daemons/seriallogger/SerialRecorder.h"

#include <QTemporaryDir>
#include <QtTest>

#include <csignal>
#include <limits>
#include <random>
#include <sys/resource.h>

using namespace hermes;

namespace {

const Arrival first{1700000000000000000, 5000000000};

/// So many seconds after the first arrival; the stamp's clock may step on its own.
Arrival after(double seconds, double step_s = 0) {
    return {first.stamp_ns + std::int64_t((seconds + step_s) * 1e9),
            first.mono_ns + std::int64_t(seconds * 1e9)};
}

void push(ChunkQueue &queue, const QByteArray &bytes, const Arrival &arrival) {
    queue.push(bytes.constData(), std::size_t(bytes.size()), arrival);
}

QByteArray contentOf(const QString &path) {
    QFile file(path);
    return file.open(QIODevice::ReadOnly) ? file.readAll() : "unreadable: " + path.toUtf8();
}

void put(const QString &path, const QByteArray &bytes) {
    QFile file(path);
    QVERIFY(file.open(QIODevice::WriteOnly));
    QCOMPARE(file.write(bytes), qint64(bytes.size()));
}

QList<QJsonObject> eventsOf(const QString &folder) {
    QList<QJsonObject> events;
    for (const QByteArray &line : contentOf(folder + "/logger-events.jsonl").split('\n'))
        if (!line.isEmpty())
            events.append(QJsonDocument::fromJson(line).object());
    return events;
}

/// All pieces, or what was wrong.
Result<QList<SerialLogReader::Piece>> readAll(const QString &base) {
    SerialLogReader reader;
    if (const Result<void> opened = reader.open(base); !opened)
        return opened.error();
    QList<SerialLogReader::Piece> pieces;
    for (;;) {
        const auto piece = reader.next();
        if (!piece)
            return piece.error();
        if (piece->bytes.isEmpty())
            return pieces;
        pieces.append(*piece);
    }
}

/// No file of this process may become longer while this lives: as on a full disk, without needing one.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() { setrlimit(RLIMIT_FSIZE, &before_); }

private:
    rlimit before_;
};

} // namespace

class TestSerialFiles : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init();
    void recordsEveryByteWithItsTime();
    void clocksMayStepBack();
    void lossesAreNotedWhereTheyWere();
    void marksAndEventsStandInOrder();
    void nothingIsOverwritten();
    void aFullDiskLeavesWhatIsRight_data();
    void aFullDiskLeavesWhatIsRight();
    void whatWasCutOffIsRepaired();
    void damageIsNamed_data();
    void damageIsNamed();
    void longChunksComeInPieces();
    void linesAreExported();
    void bytesAreExported();
    void fixesAreExported();
    void exportsFailInOrder();

private:
    RecordingPlan plan() const { return {folder_->path(), "logger", 0, 0}; }
    QString base() const { return folder_->filePath("logger-a"); }
    /// The CSV without its header.
    QList<QByteArray> exported(ExportRows rows);

    std::unique_ptr<QTemporaryDir> folder_;
};

void TestSerialFiles::init() {
    folder_ = std::make_unique<QTemporaryDir>();
}

void TestSerialFiles::recordsEveryByteWithItsTime() {
    ChunkQueue a(1 << 20), b(1 << 20);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "serial:///dev/a", &a}, {"b", "udp://0.0.0.0:1", &b}});
    push(a, "before", after(0));
    QVERIFY(recorder.begin(plan()).ok());
    std::mt19937 random(1);
    QByteArray sent;
    QList<Arrival> arrivals;
    for (int i = 0; i < 3000; ++i) {
        QByteArray bytes(int(1 + random() % 200), 0);
        for (char &byte : bytes)
            byte = char(random());
        push(a, bytes, after(i * 0.001));
        sent += bytes;
        arrivals += after(i * 0.001);
    }
    push(b, QByteArray("\0", 1), after(7));
    recorder.end();
    push(a, "behind", after(9));
    QCOMPARE(contentOf(base() + ".raw"), sent);
    QCOMPARE(contentOf(folder_->filePath("logger-b.raw")), QByteArray("\0", 1));
    const auto pieces = readAll(base());
    QVERIFY(pieces.ok());
    QCOMPARE(pieces->size(), arrivals.size());
    QByteArray read;
    for (int i = 0; i < pieces->size(); ++i) {
        QCOMPARE(pieces->at(i).offset, quint64(read.size()));
        QCOMPARE(pieces->at(i).arrival.stamp_ns, arrivals[i].stamp_ns);
        QCOMPARE(pieces->at(i).arrival.mono_ns, arrivals[i].mono_ns);
        read += pieces->at(i).bytes;
    }
    QCOMPARE(read, sent);
    const RecordingState state = recorder.state();
    QVERIFY(!state.error);
    QCOMPARE(state.bytes, sent.size() + 1.0);
    QCOMPARE(state.counts.value("chunks").toInt(), 3001);
    QCOMPARE(state.losses, (QJsonObject{{"queue_bytes", 0}, {"disk_bytes", 0}, {"events", 0}}));
    const QJsonObject file = state.files.at(0).toObject();
    QCOMPARE(file.value("name").toString(), "logger-a.raw");
    QCOMPARE(file.value("url").toString(), "serial:///dev/a");
    QCOMPARE(file.value("first_stamp").toDouble(), after(0).stamp());
    QCOMPARE(file.value("last_stamp").toDouble(), after(2.999).stamp());
}

void TestSerialFiles::clocksMayStepBack() {
    ChunkQueue queue(1000);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    QVERIFY(recorder.begin(plan()).ok());
    push(queue, "one", after(1));
    push(queue, "two", after(2, -3600));
    push(queue, "three", {-1, after(3).mono_ns}); // before 1970
    recorder.end();
    const auto pieces = readAll(base());
    QCOMPARE(pieces->size(), 3);
    QCOMPARE(pieces->at(1).arrival.stamp_ns, after(2, -3600).stamp_ns);
    QCOMPARE(pieces->at(2).arrival.stamp_ns, std::int64_t(-1));
    for (int i = 0; i < 3; ++i)
        QCOMPARE(pieces->at(i).arrival.mono_ns, after(i + 1).mono_ns);
    QVERIFY(exported(ExportRows::Bytes)[2].startsWith("-0.000000001,8.000000000,6,"));
}

void TestSerialFiles::lossesAreNotedWhereTheyWere() {
    ChunkQueue queue(10);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    QVERIFY(recorder.begin(plan()).ok());
    push(queue, "0123456789ab", after(1)); // larger than the queue: dropped whenever the writer looks
    push(queue, "right", after(2));
    QTRY_COMPARE(recorder.state().bytes, 5.0);
    push(queue, "0123456789a", after(3));
    recorder.end();
    QCOMPARE(contentOf(base() + ".raw"), QByteArray("right"));
    QCOMPARE(recorder.state().losses.value("queue_bytes").toInt(), 23);
    double lost = 0;
    for (const QJsonObject &event : eventsOf(folder_->path())) {
        QCOMPARE(event.value("event").toString(), "lost");
        QCOMPARE(event.value("port").toString(), "a");
        QVERIFY(event.value("offset").toInt() == (lost < 12 ? 0 : 5));
        lost += event.value("bytes").toDouble();
    }
    QCOMPARE(lost, 23.0);
}

void TestSerialFiles::marksAndEventsStandInOrder() {
    ChunkQueue queue(10);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    QVERIFY(!recorder.note("mark", {{"text", "too early"}}));
    QVERIFY(recorder.begin(plan()).ok());
    QVERIFY(recorder.note("mark", {{"text", "line\nbreak \"and\" \u20ac"}}, after(1)));
    QVERIFY(recorder.note("closed", {{"port", "a"}}, after(0)));
    const QString large(300000, 'x');
    int accepted = 0;
    for (int i = 0; i < 100; ++i)
        accepted += recorder.note("mark", {{"text", large}});
    recorder.end();
    QVERIFY(!recorder.note("mark", {{"text", "too late"}}));
    const auto events = eventsOf(folder_->path());
    QCOMPARE(events.size(), 2 + accepted);
    QCOMPARE(events[0].value("text").toString(), QString::fromUtf8("line\nbreak \"and\" \xe2\x82\xac"));
    QCOMPARE(events[0].value("stamp").toDouble(), after(1).stamp());
    QCOMPARE(events[0].value("mono").toDouble(), after(1).mono());
    QCOMPARE(events[1].value("event").toString(), "closed");
    QCOMPARE(recorder.state().counts.value("marks").toInt(), 1 + accepted);
    QCOMPARE(recorder.state().losses.value("events").toInt(), 100 - accepted);
}

void TestSerialFiles::nothingIsOverwritten() {
    put(base() + ".raw", "precious");
    ChunkQueue queue(10);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    const auto begun = recorder.begin(plan());
    QVERIFY(!begun.ok());
    QCOMPARE(begun.error().code, int(ErrorCode::InputOutput));
    QCOMPARE(begun.error().data.toObject().value("path").toString(), base() + ".raw");
    QCOMPARE(contentOf(base() + ".raw"), QByteArray("precious"));
}

void TestSerialFiles::aFullDiskLeavesWhatIsRight_data() {
    QTest::addColumn<int>("limit");
    QTest::addColumn<int>("chunk");
    QTest::newRow("bytes do not fit") << 10000 << 700;
    QTest::newRow("index does not fit") << 10000 << 3;
    QTest::newRow("index does not fit, half a record") << 10003 << 3;
    QTest::newRow("header does not fit") << 20 << 100;
}

void TestSerialFiles::aFullDiskLeavesWhatIsRight() {
    QFETCH(int, limit);
    QFETCH(int, chunk);
    ChunkQueue queue(1 << 20);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    QVERIFY(recorder.begin(plan()).ok());
    QByteArray sent;
    int accepted = 0;
    {
        const FileSizeLimit full{rlim_t(limit)};
        while (!recorder.state().error) {
            const QByteArray bytes(chunk, char('a' + accepted % 26));
            push(queue, bytes, after(accepted++));
            sent += bytes;
        }
        recorder.end();
    }
    QCOMPARE(recorder.state().error->code, int(ErrorCode::InputOutput));
    QVERIFY(recorder.state().error->data.toObject().value("path").toString().startsWith(base()));
    const QByteArray raw = contentOf(base() + ".raw");
    QVERIFY(raw.size() <= limit && sent.startsWith(raw));
    QCOMPARE(recorder.state().bytes, double(raw.size()));
    QVERIFY(recorder.state().losses.value("disk_bytes").toDouble() > 0);
    const auto pieces = readAll(base());
    QVERIFY2(pieces.ok(), pieces.ok() ? "" : qPrintable(pieces.error().message));
    QByteArray read;
    for (int i = 0; i < pieces->size(); ++i) {
        QCOMPARE(pieces->at(i).arrival.mono_ns, after(i).mono_ns);
        read += pieces->at(i).bytes;
    }
    QCOMPARE(read, raw);
    QCOMPARE(QFileInfo(base() + ".index").size(), qint64(16 + 24 * pieces->size()));
}

void TestSerialFiles::whatWasCutOffIsRepaired() {
    ChunkQueue a(1000), b(1000);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &a}, {"b", "v", &b}});
    QVERIFY(recorder.begin(plan()).ok());
    recorder.note("mark", {{"text", "here"}});
    for (int i = 0; i < 10; ++i)
        push(a, "0123456789", after(i));
    recorder.end();
    const RecordingState state = recorder.state();
    QJsonObject sidecar{{"start", after(0).stamp()}, {"files", state.files}, {"bytes", 0}};
    // Killed after the index was written, in the middle of the bytes, and in the middle of an event.
    const QByteArray raw = contentOf(base() + ".raw").left(64);
    put(base() + ".raw", raw);
    put(base() + ".index", contentOf(base() + ".index") + "half a record");
    const QString events = folder_->filePath("logger-events.jsonl");
    put(events, contentOf(events) + "{\"event\":\"ma");
    const auto repaired = recorder.repair(plan(), sidecar);
    QVERIFY2(repaired.ok(), repaired.ok() ? "" : qPrintable(repaired.error().message));
    QCOMPARE(contentOf(base() + ".raw"), raw);
    QCOMPARE(QFileInfo(base() + ".index").size(), qint64(16 + 24 * 7));
    QCOMPARE(readAll(base())->last().bytes, QByteArray("0123"));
    QCOMPARE(eventsOf(folder_->path()).size(), 1);
    QCOMPARE(sidecar.value("bytes").toInt(), 64);
    QCOMPARE(sidecar.value("end").toDouble(), after(6).stamp());
    QCOMPARE(sidecar.value("counts").toObject(),
             (QJsonObject{{"bytes", 64}, {"chunks", 7}, {"events", 1}, {"marks", 1}}));
    QCOMPARE(sidecar.value("files").toArray().at(0).toObject().value("bytes").toInt(), 64);
    const QJsonObject again = sidecar;
    QVERIFY(recorder.repair(plan(), sidecar).ok());
    QCOMPARE(sidecar, again);
}

void TestSerialFiles::damageIsNamed_data() {
    QTest::addColumn<QByteArray>("raw");
    QTest::addColumn<QByteArray>("index");
    QTest::addColumn<QString>("complaint");
    const QByteArray header = "HERMESIX" + QByteArray::fromHex("0100000018000000");
    const auto record = [](qint64 offset) {
        QByteArray bytes(24, 0);
        qToLittleEndian<qint64>(offset, bytes.data());
        return bytes;
    };
    QTest::newRow("no header") << QByteArray("abc") << QByteArray() << "HERMESIX";
    QTest::newRow("another file") << QByteArray("abc") << QByteArray(100, 'x') << "HERMESIX";
    QTest::newRow("another version") << QByteArray("abc")
                                     << "HERMESIX" + QByteArray::fromHex("0200000018000000") << "version 1";
    QTest::newRow("no records") << QByteArray("abc") << header << "first record";
    QTest::newRow("begins late") << QByteArray("abc") << header + record(1) << "first record";
    QTest::newRow("turns back") << QByteArray("abcdef") << header + record(0) + record(3) + record(2)
                                << "a record at byte 2 follows one at byte 3";
    QTest::newRow("twice") << QByteArray("abcdef") << header + record(0) + record(0) << "at byte 0 follows";
    QTest::newRow("negative") << QByteArray("abc") << header + record(-1) << "first record";
}

void TestSerialFiles::damageIsNamed() {
    QFETCH(QByteArray, raw);
    QFETCH(QByteArray, index);
    QFETCH(QString, complaint);
    put(base() + ".raw", raw);
    put(base() + ".index", index);
    const auto pieces = readAll(base());
    QVERIFY(!pieces.ok());
    QVERIFY2(pieces.error().message.contains(complaint) && pieces.error().message.contains("logger-a.index"),
             qPrintable(pieces.error().message));
    QCOMPARE(pieces.error().data.toObject().value("path").toString(), base() + ".index");
    SerialExport job;
    job.base = base();
    job.target = base() + "-lines.csv";
    QVERIFY(!job.run(false).ok() && !QFile::exists(job.target));
}

void TestSerialFiles::longChunksComeInPieces() {
    ChunkQueue queue(1 << 20);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    QVERIFY(recorder.begin(plan()).ok());
    const QByteArray large(SerialLogReader::mostBytes + 5, 'x');
    push(queue, large, after(1));
    push(queue, "end", after(2));
    recorder.end();
    const auto pieces = readAll(base());
    QCOMPARE(pieces->size(), 3);
    QCOMPARE(pieces->at(1).bytes.size(), 5);
    QCOMPARE(pieces->at(1).arrival.mono_ns, after(1).mono_ns);
    QCOMPARE(pieces->at(2).offset, quint64(large.size()));
}

QList<QByteArray> TestSerialFiles::exported(ExportRows rows) {
    SerialExport job;
    job.base = base();
    job.target = base() + ".csv";
    job.rows = rows;
    const auto count = job.run(false);
    if (!count)
        return {count.error().message.toUtf8()};
    QList<QByteArray> lines = contentOf(job.target).split('\n');
    lines.removeFirst();
    lines.removeLast();
    if (lines.size() != *count)
        return {"another number of rows was told"};
    return lines;
}

void TestSerialFiles::linesAreExported() {
    ChunkQueue queue(1 << 20);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    QVERIFY(recorder.begin(plan()).ok());
    push(queue, "one\r\ntw", after(0.5));
    push(queue, "o, \"2\"\n\xc3\\\t", after(1));
    recorder.end();
    QCOMPARE(exported(ExportRows::Lines),
             (QList<QByteArray>{"1700000000.500000000,5.500000000,0,\"one\"",
                                "1700000000.500000000,5.500000000,5,\"two, \"\"2\"\"\"",
                                "1700000001.000000000,6.000000000,14,\"\\xC3\\\\\t\""}));
}

void TestSerialFiles::bytesAreExported() {
    ChunkQueue queue(1 << 20);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    QVERIFY(recorder.begin(plan()).ok());
    push(queue, QByteArray("\0\xff\n", 3), after(0));
    push(queue, "a", after(1e-9));
    recorder.end();
    QCOMPARE(exported(ExportRows::Bytes), (QList<QByteArray>{"1700000000.000000000,5.000000000,0,00ff0a",
                                                             "1700000000.000000001,5.000000001,3,61"}));
}

void TestSerialFiles::fixesAreExported() {
    ChunkQueue queue(1 << 20);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    QVERIFY(recorder.begin(plan()).ok());
    push(queue, "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A\r\n", after(0));
    push(queue, "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n", after(1));
    recorder.end();
    const auto rows = exported(ExportRows::Fixes);
    QCOMPARE(rows.size(), 1);
    const QList<QByteArray> cells = rows[0].split(',');
    QCOMPARE(cells.size(), 12);
    QCOMPARE(cells[0], QByteArray("1700000000.000000000"));
    QCOMPARE(cells[2].toDouble(), 764426119.0);
    QCOMPARE(cells[3], QByteArray("1"));
    QCOMPARE(cells[4].toDouble(), 48 + 7.038 / 60);
    QCOMPARE(cells[6].toDouble(), 545.4);
    QCOMPARE(cells[8].toDouble(), 8.0);
}

void TestSerialFiles::exportsFailInOrder() {
    SerialExport job;
    job.base = base();
    job.target = folder_->filePath("no/such/folder.csv");
    QVERIFY(job.run(false).error().message.contains("logger-a.index: cannot be read"));
    ChunkQueue queue(1 << 20);
    SerialRecorder recorder;
    recorder.setPorts({{"a", "u", &queue}});
    QVERIFY(recorder.begin(plan()).ok());
    for (int i = 0; i < 1000; ++i)
        push(queue, "a line of twenty bytes\n", after(i));
    recorder.end();
    QCOMPARE(job.run(false).error().data.toObject().value("path").toString(), job.target);
    job.target = base() + ".csv";
    QCOMPARE(job.run(true).error().code, int(ErrorCode::NotReady));
    {
        const FileSizeLimit full(1000);
        QCOMPARE(job.run(false).error().code, int(ErrorCode::InputOutput));
    }
    QVERIFY(!QFile::exists(job.target));
    QCOMPARE(job.run(false).value(), 1000.0);
}

QTEST_GUILESS_MAIN(TestSerialFiles)
#include "TestSerialFiles.moc"
