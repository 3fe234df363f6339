#include "SerialFilesFixture.h"

using namespace hermes;

class TestSerialRecorder : public QObject, SerialFilesFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { folder_ = std::make_unique<QTemporaryDir>(); }

    void recordsEveryByteWithItsTime() {
        ChunkQueue a(1 << 20), b(1 << 20);
        SerialRecorder recorder;
        recorder.setPorts({{"a", "serial:///dev/a", &a}, {"b", "udp://0.0.0.0:1", &b}});
        push(a, "before", after(0));
        QVERIFY(recorder.begin(plan()).ok());
        std::mt19937 random(1);
        QByteArray sent;
        QList<Moment> arrivals;
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
        QCOMPARE(int(state.counts.value("chunks")), 3001);
        QCOMPARE(state.losses, (NamedCounts{{"queue_bytes", 0}, {"disk_bytes", 0}, {"events", 0}}));
        const QJsonObject file = state.files.at(0).toObject();
        QCOMPARE(file.value("name").toString(), "logger-a.raw");
        QCOMPARE(file.value("url").toString(), "serial:///dev/a");
        QCOMPARE(file.value("first_stamp").toDouble(), after(0).stamp());
        QCOMPARE(file.value("last_stamp").toDouble(), after(2.999).stamp());
    }

    void clocksMayStepBack() {
        begin(1000);
        push(*queue_, "one", after(1));
        push(*queue_, "two", after(2, -3600));
        push(*queue_, "three", {-1, after(3).mono_ns}); // before 1970
        recorder_->end();
        const auto pieces = readAll(base());
        QCOMPARE(pieces->size(), 3);
        QCOMPARE(pieces->at(1).arrival.stamp_ns, after(2, -3600).stamp_ns);
        QCOMPARE(pieces->at(2).arrival.stamp_ns, std::int64_t(-1));
        for (int i = 0; i < 3; ++i)
            QCOMPARE(pieces->at(i).arrival.mono_ns, after(i + 1).mono_ns);
    }

    void lossesAreNotedWhereTheyWere() {
        begin(10);
        push(*queue_, "0123456789ab", after(1)); // larger than the queue: dropped whenever the writer looks
        push(*queue_, "right", after(2));
        QTRY_COMPARE(recorder_->state().bytes, 5.0);
        push(*queue_, "0123456789a", after(3));
        recorder_->end();
        QCOMPARE(contentOf(base() + ".raw"), QByteArray("right"));
        QCOMPARE(int(recorder_->state().losses.value("queue_bytes")), 23);
        double lost = 0;
        for (const QJsonObject &event : eventsOf(folder_->path())) {
            QCOMPARE(event.value("event").toString(), "lost");
            QCOMPARE(event.value("port").toString(), "a");
            QVERIFY(event.value("offset").toInt() == (lost < 12 ? 0 : 5));
            lost += event.value("bytes").toDouble();
        }
        QCOMPARE(lost, 23.0);
    }

    void marksAndEventsStandInOrder() {
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
        QCOMPARE(int(recorder.state().counts.value("marks")), 1 + accepted);
        QCOMPARE(int(recorder.state().losses.value("events")), 100 - accepted);
    }

    void nothingIsOverwritten() {
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

    void aFullDiskLeavesWhatIsRight_data() {
        const Rows<int, int> row("limit", "chunk");
        row("bytes do not fit", 10000, 700);
        row("index does not fit", 10000, 3);
        row("index does not fit, half a record", 10003, 3);
        row("header does not fit", 20, 100);
    }

    void aFullDiskLeavesWhatIsRight() {
        FETCH(int, limit, int, chunk);
        begin();
        QByteArray sent;
        int accepted = 0;
        {
            const FileSizeLimit full{rlim_t(limit)};
            while (!recorder_->state().error) {
                const QByteArray bytes(chunk, char('a' + accepted % 26));
                push(*queue_, bytes, after(accepted++));
                sent += bytes;
            }
            recorder_->end();
        }
        QCOMPARE(recorder_->state().error->code, int(ErrorCode::InputOutput));
        QVERIFY(recorder_->state().error->data.toObject().value("path").toString().startsWith(base()));
        const QByteArray raw = contentOf(base() + ".raw");
        QVERIFY(raw.size() <= limit && sent.startsWith(raw));
        QCOMPARE(recorder_->state().bytes, double(raw.size()));
        QVERIFY(recorder_->state().losses.value("disk_bytes") > 0);
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
};
