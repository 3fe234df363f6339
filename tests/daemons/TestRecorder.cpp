#include "common/capture/PcapReader.h"
#include "daemons/velodynelogger/Recorder.h"
#include "protocol/wire/Fields.h"
#include "tests/support/Sensor.h"

using namespace hermes;
using namespace hermes::velodynelogger;

static RecordingPlan planIn(const QTemporaryDir &folder) {
    return {folder.path(), "velodynelogger", 1e9, 3600};
}

static std::vector<std::int64_t> stampsOf(const QString &path) {
    std::vector<std::int64_t> stamps;
    PcapReader reader;
    Datagram datagram;
    if (!reader.open(path.toStdString()))
        qFatal("%s", reader.error().c_str());
    PcapReader::Next next;
    while ((next = reader.next(datagram)) == PcapReader::Next::Datagram)
        stamps.push_back(datagram.stamp_ns);
    if (next == PcapReader::Next::Failed)
        qFatal("%s", reader.error().c_str());
    return stamps;
}

static QStringList captures(const QTemporaryDir &folder) {
    return QDir(folder.path()).entryList({"*.pcap"}, QDir::Files, QDir::Name);
}

static void push(Recorder &recorder, const Sensor &sensor, int first, int end) {
    for (int i = first; i < end; ++i)
        recorder.push(sensorDatagram(sensor.packet(i), sensor.stamp(i)), true);
}

/// What a process leaves that is killed: the sidecar as it was a moment before, the files as they are.
static QJsonObject sidecarOf(const RecordingState &state) {
    return {{"files", state.files},
            {"counts", asJson(state.counts)},
            {"losses", asJson(state.losses)},
            {"start", 1.0},
            {"end", 1.0}};
}

class TestRecorder : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void writesWhatIsPushed() {
        QTemporaryDir folder;
        const Sensor sensor;
        Recorder recorder;
        recorder.push(sensorDatagram(sensor.packet(0), 1), false); // nobody records
        QVERIFY(recorder.begin(planIn(folder)).ok());
        push(recorder, sensor, 0, 3000);
        recorder.end();
        recorder.push(sensorDatagram(sensor.packet(0), 1), false);
        const RecordingState state = recorder.state();
        QVERIFY(!state.error);
        QCOMPARE(int(state.counts.value("packets")), 3000);
        QCOMPARE(int(state.counts.value("data")), 3000);
        for (const double loss : state.losses)
            QCOMPARE(int(loss), 0);
        QCOMPARE(state.path, folder.path() + "/velodynelogger-0001.pcap");
        QCOMPARE(double(QFileInfo(state.path).size()), state.bytes);
        PcapReader reader;
        QVERIFY(reader.open(state.path.toStdString()));
        Datagram datagram;
        for (int i = 0; i < 3000; ++i) {
            QCOMPARE(reader.next(datagram), PcapReader::Next::Datagram);
            QCOMPARE(datagram.stamp_ns, sensor.stamp(i));
            const auto packet = sensor.packet(i);
            QVERIFY(datagram.size == packet.size() &&
                    std::equal(packet.begin(), packet.end(), datagram.payload));
        }
        QCOMPARE(reader.next(datagram), PcapReader::Next::End);
    }

    void existingFilesAreNotTouched() {
        QTemporaryDir folder;
        QFile file(folder.filePath("velodynelogger-0001.pcap"));
        QVERIFY(file.open(QIODevice::WriteOnly) && file.write("mine") == 4);
        file.close();
        Recorder recorder;
        const Result<void> refused = recorder.begin(planIn(folder));
        QCOMPARE(refused.error().code, int(ErrorCode::InputOutput));
        QVERIFY(refused.error().message.contains("exists already"));
        QVERIFY(!recorder.isRecording());
        QCOMPARE(file.size(), 4);
    }

    void goesOnInANewFileBySize() {
        QTemporaryDir folder;
        const Sensor sensor;
        RecordingPlan plan = planIn(folder);
        const int record = 16 + 42 + 1206;
        plan.fileBytes = 24 + 100 * record + 500; // a hundred, and a half that must not be begun
        Recorder recorder;
        QVERIFY(recorder.begin(plan).ok());
        push(recorder, sensor, 0, 1050);
        recorder.end();
        QCOMPARE(captures(folder).size(), 11);
        const RecordingState state = recorder.state();
        QCOMPARE(state.files.size(), 11);
        std::vector<std::int64_t> all;
        for (const QJsonValue &entry : state.files) {
            const QJsonObject file = entry.toObject();
            const std::vector<std::int64_t> stamps = stampsOf(folder.filePath(file.value("name").toString()));
            QCOMPARE(double(stamps.size()), file.value("packets").toDouble());
            QCOMPARE(24 + double(stamps.size()) * record, file.value("bytes").toDouble());
            QCOMPARE(double(stamps.front()) * 1e-9, file.value("start").toDouble());
            QCOMPARE(double(stamps.back()) * 1e-9, file.value("end").toDouble());
            all.insert(all.end(), stamps.begin(), stamps.end());
        }
        QCOMPARE(all.size(), std::size_t(1050));
        for (int i = 0; i < 1050; ++i)
            QCOMPARE(all[std::size_t(i)], sensor.stamp(i));
    }

    void goesOnInANewFileByTime() {
        QTemporaryDir folder;
        Sensor sensor;
        RecordingPlan plan = planIn(folder);
        plan.fileSeconds = 0.2;
        Recorder recorder;
        QVERIFY(recorder.begin(plan).ok());
        auto timer = runningTimer();
        int pushed = 0;
        while (recorder.state().files.size() <
               3) { // the host's clock, set back by each packet, does not count
            recorder.push(sensorDatagram(sensor.packet(pushed), 1700000000000000000 - pushed), true);
            ++pushed;
            QTest::qWait(2);
            QVERIFY(timer.elapsed() < 20000);
        }
        QVERIFY(timer.elapsed() >= 400);
        recorder.end();
        QCOMPARE(int(recorder.state().counts.value("packets")), pushed);
        QCOMPARE(int(recorder.state().counts.value("host_clock_steps")), pushed - 1);
    }

    void aReaderSeesItAtOnce() {
        QTemporaryDir folder;
        const Sensor sensor;
        Recorder recorder;
        QVERIFY(recorder.begin(planIn(folder)).ok());
        for (int i = 0; i < 5; ++i) {
            push(recorder, sensor, i, i + 1);
            auto timer = runningTimer();
            const QFileInfo file(folder.filePath("velodynelogger-0001.pcap"));
            const qint64 expected = 24 + (i + 1) * (16 + 42 + 1206);
            while (QFileInfo(file.filePath()).size() < expected)
                QVERIFY(timer.elapsed() < 5000);
            QCOMPARE(QFileInfo(file.filePath()).size(), expected);
        }
    }

    void countsWhatItDrops() {
        QTemporaryDir folder;
        const Sensor sensor;
        Recorder recorder(10 * 1300);
        QVERIFY(recorder.begin(planIn(folder)).ok());
        for (int i = 0; i < 5000; ++i)
            recorder.push(sensorDatagram(sensor.packet(i), sensor.stamp(i)), false);
        recorder.end();
        const RecordingState state = recorder.state();
        const int written = int(state.counts.value("packets")), dropped = int(state.losses.value("queue"));
        QVERIFY(written >= 9 && dropped > 0);
        QCOMPARE(written + dropped, 5000);
        // The sensor's stamps tell the same, but for what is missing at the end.
        QVERIFY(int(state.losses.value("missing")) <= dropped);
        QCOMPARE(stampsOf(state.path).size(), std::size_t(written));
    }

    void lossesOfTheReceiverAreItsOwn() {
        QTemporaryDir folder;
        Recorder recorder;
        recorder.noteLosses(100, 100); // of nobody
        QVERIFY(recorder.begin(planIn(folder)).ok());
        recorder.noteLosses(3, 0);
        recorder.noteLosses(4, 1);
        QCOMPARE(int(recorder.state().losses.value("kernel")), 7);
        QCOMPARE(int(recorder.state().losses.value("too_long")), 1);
    }

    void reportsTheDisk() {
        QTemporaryDir folder;
        const Sensor sensor;
        Recorder recorder;
        std::optional<FileSizeLimit> disk(1000000);
        QVERIFY(recorder.begin(planIn(folder)).ok());
        push(recorder, sensor, 0, 2000);
        QTRY_VERIFY(recorder.state().error);
        disk.reset();
        recorder.end();
        const RecordingState state = recorder.state();
        QCOMPARE(state.error->code, int(ErrorCode::InputOutput));
        VERIFY_CONTAINS(state.error->message, "File too large");
        QCOMPARE(state.error->data.toObject().value("path").toString(), state.path);
        const int written = int(state.counts.value("packets"));
        QVERIFY(written > 0 && int(state.losses.value("unwritten")) > 0);
        QCOMPARE(stampsOf(state.path).size(), std::size_t(written)); // what is there is whole
        QCOMPARE(double(QFileInfo(state.path).size()), state.bytes);
        // And the next recording is one.
        QTemporaryDir other;
        QVERIFY(recorder.begin(planIn(other)).ok());
        push(recorder, sensor, 0, 100);
        recorder.end();
        QVERIFY(!recorder.state().error);
        QCOMPARE(int(recorder.state().counts.value("packets")), 100);
        QCOMPARE(int(recorder.state().losses.value("unwritten")), 0);
    }

    void repairReadsOnWhereTheSidecarEnds_data() {
        const Rows<int, int> row(
            "known", "cut"); // known: packets when the sidecar was written; cut: bytes missing at the end
        row("whole, all known", 300, 0);
        row("whole", 120, 0);
        row("cut in a payload", 120, 100);
        row("cut in a record's header", 120, 1206 + 42 + 3);
        row("sidecar knows nothing", 0, 1);
        row("sidecar knows more than is there", 300, 1000 * 100);
    }

    void repairReadsOnWhereTheSidecarEnds() {
        FETCH(int, known, int, cut);
        QTemporaryDir folder;
        const Sensor sensor;
        RecordingPlan plan = planIn(folder);
        const int record = 16 + 42 + 1206;
        plan.fileBytes = 24 + 100 * record;
        Recorder recorder;
        QVERIFY(recorder.begin(plan).ok());
        push(recorder, sensor, 0, known);
        QTRY_COMPARE(int(recorder.state().counts.value("packets")), known);
        QJsonObject sidecar = sidecarOf(recorder.state());
        push(recorder, sensor, known, 300);
        recorder.end();
        const QString last = folder.filePath("velodynelogger-0003.pcap");
        QVERIFY(QFile::resize(last, QFileInfo(last).size() - cut));
        const int left = 300 - (cut + record - 1) / record;

        QVERIFY(Recorder().repair(plan, sidecar).ok());
        QCOMPARE(sidecar.value("counts").toObject().value("packets").toInt(), left);
        QCOMPARE(sidecar.value("files").toArray().size(), 3);
        QCOMPARE(sidecar.value("bytes").toInt(), 3 * 24 + left * record);
        QCOMPARE(sidecar.value("end").toDouble(), double(sensor.stamp(left - 1)) * 1e-9);
        QCOMPARE(sidecar.value("files").toArray()[2].toObject().value("start").toDouble(),
                 double(sensor.stamp(200)) * 1e-9);
        QCOMPARE(stampsOf(last).size(), std::size_t(left - 200));
    }

    void repairOfDamagedFiles() {
        QTemporaryDir folder;
        const Sensor sensor;
        Recorder recorder;
        QVERIFY(recorder.begin(planIn(folder)).ok());
        push(recorder, sensor, 0, 100);
        recorder.end();
        const auto put = [&](const char *name, const QByteArray &bytes) {
            QFile file(folder.filePath(name));
            return file.open(QIODevice::WriteOnly | QIODevice::Append) && file.write(bytes) == bytes.size();
        };
        QVERIFY(put("velodynelogger-0001.pcap", QByteArray(5000, '\0'))); // what a power cut leaves
        QVERIFY(put("velodynelogger-0002.pcap", ""));
        QVERIFY(put("notes-0003.pcap", "mine"));
        QJsonObject sidecar{{"start", 1.0}, {"end", 1.0}};
        QVERIFY(recorder.repair(planIn(folder), sidecar).ok());
        QCOMPARE(sidecar.value("counts").toObject().value("packets").toInt(), 100);
        QCOMPARE(captures(folder), QStringList({"notes-0003.pcap", "velodynelogger-0001.pcap"}));
        QCOMPARE(stampsOf(folder.filePath("velodynelogger-0001.pcap")).size(), std::size_t(100));
        QVERIFY(put("velodynelogger-0002.pcap", QByteArray(5000, 'x')));
        const Result<void> refused = recorder.repair(planIn(folder), sidecar);
        QCOMPARE(refused.error().data.toObject().value("path").toString(),
                 folder.filePath("velodynelogger-0002.pcap"));
        QCOMPARE(QFileInfo(folder.filePath("velodynelogger-0002.pcap")).size(), 5000); // left alone
        QVERIFY(QFile::remove(folder.filePath("velodynelogger-0002.pcap")));
        QTemporaryDir other; // a capture of somebody else's, with something behind its packets
        QFile victim(other.filePath("victim"));
        QVERIFY(QFile::copy(folder.filePath("velodynelogger-0001.pcap"), victim.fileName()));
        QVERIFY(victim.open(QIODevice::Append) && victim.write("precious") == 8);
        victim.close();
        const qint64 size = victim.size();
        QVERIFY(QFile::link(victim.fileName(), folder.filePath("velodynelogger-0002.pcap")));
        QVERIFY(!recorder.repair(planIn(folder), sidecar).ok());
        QCOMPARE(victim.size(), size);
    }
};
