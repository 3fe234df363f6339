// Recordings of ports that were cut off or damaged, and how they are read.
#include "SerialFilesFixture.h"
#include "common/recording/Sidecar.h"

using namespace hermes;

class TestSerialRepair : public QObject, SerialFilesFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { folder_ = std::make_unique<QTemporaryDir>(); }

    void whatWasCutOffIsRepaired() {
        ChunkQueue a(1000), b(1000);
        SerialRecorder recorder;
        const QJsonObject about{{"model", "m"}, {"url", "x"}};
        recorder.setPorts({{"a", "u", &a, [&] { return about; }}, {"b", "v", &b}});
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
        const QJsonValue file = sidecar.value("files").toArray().at(0);
        QCOMPARE(file["bytes"].toInt(), 64);
        QCOMPARE(file["model"], QJsonValue("m"));
        QCOMPARE(file["url"], QJsonValue("u"));
        const QJsonObject again = sidecar;
        QVERIFY(recorder.repair(plan(), sidecar).ok());
        QCOMPARE(sidecar, again);
    }

    void whatLinksLeadToStays_data() {
        Rows<QString, bool>("file", "isHard");
        for (const char *file : {"logger-a.index", "logger-events.jsonl"}) {
            QTest::addRow("%s, a link", file) << file << false;
            QTest::addRow("%s, a second name", file) << file << true;
        }
    }

    void whatLinksLeadToStays() {
        FETCH(QString, file, bool, isHard);
        ChunkQueue queue(1000);
        SerialRecorder recorder;
        recorder.setPorts({{"a", "u", &queue}});
        QVERIFY(recorder.begin(plan()).ok());
        recorder.end();
        QTemporaryDir other;
        const QString victim = other.filePath("victim"), link = folder_->filePath(file);
        put(victim, contentOf(base() + ".index") + "precious"); // both would be cut
        QVERIFY(QFile::remove(link));
        const auto make = isHard ? ::link : ::symlink;
        QCOMPARE(make(QFile::encodeName(victim), QFile::encodeName(link)), 0);
        QJsonObject sidecar{{"files", recorder.state().files}};
        const auto repaired = recorder.repair(plan(), sidecar);
        QVERIFY(!repaired);
        QCOMPARE(repaired.error().data.toObject().value("path").toString(), link);
        QVERIFY(contentOf(victim).endsWith("precious"));
    }

    void damageIsNamed_data() {
        const Rows<QByteArray, QByteArray, QString> row("raw", "index", "complaint");
        const QByteArray header = "HERMESIX" + QByteArray::fromHex("0100000018000000");
        const auto record = [](qint64 offset) {
            QByteArray bytes(24, 0);
            qToLittleEndian<qint64>(offset, bytes.data());
            return bytes;
        };
        row("no header", "abc", QByteArray(), "HERMESIX");
        row("another file", "abc", QByteArray(100, 'x'), "HERMESIX");
        row("another version", "abc", "HERMESIX" + QByteArray::fromHex("0200000018000000"), "version 1");
        row("no records", "abc", header, "first record");
        row("begins late", "abc", header + record(1), "first record");
        row("turns back", "abcdef", header + record(0) + record(3) + record(2),
            "a record at byte 2 follows one at byte 3");
        row("twice", "abcdef", header + record(0) + record(0), "at byte 0 follows");
        row("negative", "abc", header + record(-1), "first record");
    }

    void damageIsNamed() {
        FETCH(QByteArray, raw, QByteArray, index, QString, complaint);
        put(base() + ".raw", raw);
        put(base() + ".index", index);
        const auto pieces = readAll(base());
        QVERIFY(!pieces.ok());
        QVERIFY2(pieces.error().message.contains(complaint) &&
                     pieces.error().message.contains("logger-a.index"),
                 qPrintable(pieces.error().message));
        QCOMPARE(pieces.error().data.toObject().value("path").toString(), base() + ".index");
    }

    void longChunksComeInPieces() {
        begin();
        const QByteArray large(SerialLogReader::maxBytes + 5, 'x');
        push(*queue_, large, after(1));
        push(*queue_, "end", after(2));
        recorder_->end();
        const auto pieces = readAll(base());
        QCOMPARE(pieces->size(), 3);
        QCOMPARE(pieces->at(1).bytes.size(), 5);
        QCOMPARE(pieces->at(1).arrival.mono_ns, after(1).mono_ns);
        QCOMPARE(pieces->at(2).offset, quint64(large.size()));
    }
};
