#include "daemons/seriallogger/SerialExport.h"
#include "tests/common/SerialFilesFixture.h"

using namespace hermes;
using namespace hermes::seriallogger;

class TestSerialExport : public QObject, SerialFilesFixture {
    Q_OBJECT
private Q_SLOTS:
    void init() { folder_ = std::make_unique<QTemporaryDir>(); }

    void linesAreExported() {
        begin();
        push(*queue_, "one\r\ntw", after(0.5));
        push(*queue_, "o, \"2\"\n\xc3\\\t", after(1));
        recorder_->end();
        QCOMPARE(exported(ExportRows::Lines),
                 (QList<QByteArray>{"1700000000.500000000,5.500000000,0,\"one\"",
                                    "1700000000.500000000,5.500000000,5,\"two, \"\"2\"\"\"",
                                    "1700000001.000000000,6.000000000,14,\"\\xC3\\\\\t\""}));
    }

    void bytesAreExported() {
        begin();
        push(*queue_, QByteArray("\0\xff\n", 3), after(0));
        push(*queue_, "a", after(1e-9));
        push(*queue_, "b", {-1, after(3).mono_ns}); // before 1970
        recorder_->end();
        QCOMPARE(exported(ExportRows::Bytes), (QList<QByteArray>{"1700000000.000000000,5.000000000,0,00ff0a",
                                                                 "1700000000.000000001,5.000000001,3,61",
                                                                 "-0.000000001,8.000000000,4,62"}));
    }

    void fixesAreExported() {
        begin();
        push(*queue_, "$GPRMC,123519,A,4807.038,N,01131.000,E,022.4,084.4,230394,003.1,W*6A\r\n", after(0));
        push(*queue_, "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n", after(1));
        recorder_->end();
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

    void ofADamagedRecordingNoneIsMade() {
        put(base() + ".raw", "abc");
        put(base() + ".index", "another file");
        VERIFY_CONTAINS(QString(exported(ExportRows::Lines).first()), "HERMESIX");
        QVERIFY(!QFile::exists(base() + ".csv"));
    }

    void exportsFailInOrder() {
        SerialExport job;
        job.base = base();
        job.target = folder_->filePath("no/such/folder.csv");
        QVERIFY(job.run(false).error().message.contains("logger-a.index: cannot be read"));
        begin();
        for (int i = 0; i < 1000; ++i)
            push(*queue_, "a line of twenty bytes\n", after(i));
        recorder_->end();
        QCOMPARE(job.run(false).error().data.toObject().value("path").toString(), job.target);
        job.target = base() + ".csv";
        QCOMPARE(job.run(true).error().code, int(ErrorCode::NotReady));
        {
            const FileSizeLimit full(1000);
            QCOMPARE(job.run(false).error().code, int(ErrorCode::InputOutput));
        }
        QVERIFY(!QFile::exists(job.target));
        QCOMPARE(job.run(false).value(), 1000.0);
        const QByteArray whole = contentOf(job.target);
        QVERIFY(QFile::remove(job.target));
        {
            const FileSizeLimit almost(whole.size() - 10); // what is in the buffer at the end has no room
            QCOMPARE(job.run(false).error().code, int(ErrorCode::InputOutput));
        }
        QVERIFY(!QFile::exists(job.target));
    }

private:
    /// The CSV without its header.
    QList<QByteArray> exported(ExportRows rows) {
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
        if (quint64(lines.size()) != *count)
            return {"another number of rows was told"};
        return lines;
    }
};
