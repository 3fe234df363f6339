// The recorder's own part of a session: its MCAP files.
#include "daemons/recorder/McapRecorder.h"

using namespace hermes;
using namespace hermes::recorder;

class TestMcapRecorder : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void topicsWithoutRoomAreLost() {
        QTemporaryDir folder;
        McapRecorder recorder;
        QVERIFY(recorder.begin({folder.path(), "recorder"}).ok());
        const int large = recorder.addTopic({"a/large", QByteArray(17 << 20, ' '), {}});
        const int small = recorder.addTopic({"a/small", "{}", {}});
        for (const int topic : {large, small, large, small})
            recorder.write({topic, 1, 1, Moment::now(), "1"});
        recorder.end();
        const RecordingState state = recorder.state();
        QVERIFY(!state.error);
        QCOMPARE(state.counts["messages"], 2.0);
        QCOMPARE(state.losses, (NamedCounts{{"a/large", 2}}));
    }

    void aFileCutInItsHeaderIsCompleted() {
        QTemporaryDir folder;
        const RecordingPlan plan{folder.path(), "recorder"};
        for (const char *name : {"recorder-0001.mcap", "recorder-0002.mcap"}) {
            QFile file(folder.filePath(name));
            QVERIFY(file.open(QIODevice::WriteOnly));
            if (QString(name).contains('2'))
                file.write("\x89MCAP0\r\n\x01");
        }
        QJsonObject sidecar;
        QVERIFY(McapRecorder().repair(plan, sidecar).ok());
        QCOMPARE(sidecar["files"].toArray().size(), 2);
        QCOMPARE(sidecar["counts"].toObject()["messages"].toInt(-1), 0);
        for (const QJsonValue &file : sidecar["files"].toArray())
            QCOMPARE(QFileInfo(folder.filePath(file["name"].toString())).size(), file["bytes"].toInt());
    }
};
