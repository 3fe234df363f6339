#include "common/Time.h"
#include "gui/desktop/view/PlotPane.h"
#include "tests/gui/desktop/PlotWindow.h"

using namespace hermes;
using namespace hermes::desktop;

/// What the plots make of the stamps and values that daemons send: recorded ones, those that go back, and
/// what no daemon should say.
class TestPlottedStamps : public QObject, protected PlotWindow {
    Q_OBJECT
private Q_SLOTS:
    void init() { open(drive()); }
    void cleanup() { close(); }

    void recordedStampsAndThoseThatGoBack() {
        raise();
        QVERIFY(panel_->board().add(field("vx")));
        subscribed("drive");
        const double then = 1.6e9; // September 2020
        for (int i = 0; i <= 10; ++i)
            sayVx(then + i, i);
        PlotPane *const pane = panel_->board().panes()[0];
        const auto nowShown = [pane] { return pane->scene().lines[0].now; };
        QTRY_COMPARE(nowShown(), then + 10); // and not of today
        QVERIFY(panel_->board().sampler().isRecorded(field("vx")));
        panel_->board().time().setCursor(-3.2);
        QCOMPARE(pane->valueText(0), QString("7 m/s"));
        const QString shown = pane->scene().cursorTime;
        const auto time = QDateTime::fromMSecsSinceEpoch(qint64((then + 6.8) * 1000));
        QCOMPARE(shown, "-3.20 s  " + time.toString("yyyy-MM-dd HH:mm:ss.zzz").chopped(1));
        panel_->board().time().setCursor(std::nullopt);

        sayVx(then + 3, 50); // the replay went back
        QCOMPARE(int(samples("vx").size()), 1);
        sayVx(then + 4, 51);
        QCOMPARE(int(samples("vx").size()), 2);
        QTRY_COMPARE(nowShown(), then + 4);
        daemon_->say("drive", "{\"vx\":9}", QByteArray::number(then + 3.9, 'f', 3)); // late
        QTest::qWait(100);
        QCOMPARE(samples("vx").back(), QPointF(then + 4, 51));
        sayVx(stampNow(), 52); // live again
        QCOMPARE(int(samples("vx").size()), 1);
        QVERIFY(!panel_->board().sampler().isRecorded(field("vx")));
        QTRY_VERIFY(std::abs(nowShown() - stampNow()) < 2);
    }

    void recordedBesideLive() {
        raise();
        FakeDaemon other(drive());
        const QString address = other.address();
        QVERIFY(window_->fleet.add(address).ok());
        QVERIFY(panel_->board().add(field("vx")));
        QVERIFY(panel_->board().add({address, "drive", "vx"}));
        subscribed("drive");
        QTRY_VERIFY(other.subscriptions("drive") > 1);
        sayVx(1.6e9, 1);
        other.say("drive", "{\"vx\":2}", QByteArray::number(stampNow(), 'f', 3));
        const auto &lines = panel_->board().panes()[0]->scene().lines;
        QTRY_VERIFY(lines.size() == 2 && lines[0].samples->size() == 1 && lines[1].samples->size() == 1);
        QTRY_COMPARE(lines[0].now, 1.6e9);
        QTRY_VERIFY(std::abs(lines[1].now - stampNow()) < 2);
        QTRY_VERIFY2(lines[0].name.startsWith("recorded: drive vx of "), qPrintable(lines[0].name));
        QVERIFY(lines[1].name.startsWith("drive vx of "));
    }

    void hostileValues() {
        raise();
        QVERIFY(panel_->board().add(field("vx")));
        QVERIFY(panel_->board().add(field("list.1")));
        subscribed("drive");
        sayVx(0, 1);          // 1970
        sayVx(4102444800, 2); // 2100
        QTRY_COMPARE(panel_->board().panes()[0]->scene().lines[0].now, 4102444800.0);
        panel_->board().time().setCursor(-0.1);
        QVERIFY(panel_->board().panes()[0]->scene().cursorTime.contains("2099-12-31") ||
                panel_->board().panes()[0]->scene().cursorTime.contains("2100-01-01"));
        const quint64 before = panel_->board().sampler().unusable();
        for (const char *bad :
             {"{\"vx\":\"fast\"}", "{\"vx\":1e300}", "{\"vx\":[1]}", "[]", "null", "{\"list\":3}"}) {
            daemon_->say("drive", bad);
            QTest::qWait(60);
        }
        QTRY_COMPARE(panel_->board().sampler().unusable(), before + 12);
        QCOMPARE(samples("vx").back().y(), 2.0);
        daemon_->say("drive", "{\"vx\":3}", "1e300");
        QTest::qWait(100);
        QCOMPARE(samples("vx").back().y(), 2.0); // refused with its stamp
        say(4102444801, "{\"vx\":true,\"list\":[1,2]}");
        QCOMPARE(samples("list.1").back().y(), 2.0);
        QVERIFY(!panel_->grab().isNull());
    }

    void noNumbersOverCbor_data() {
        const Rows<QByteArray, QByteArray, QString> row("stamp", "value", "refusal");
        const QByteArray now = QByteArray::number(stampNow(), 'f', 3);
        for (const char *const word : {"nan", "inf", "-inf"}) { // JSON has none of them
            row(QByteArray("stamp ") + word, QByteArray(word), "7", "not finite");
            row(QByteArray("value ") + word, now, QByteArray(word), "not finite");
        }
        for (const char *const word : {"1e11", "-1e300"})
            row(QByteArray("stamp ") + word, QByteArray(word), "7", "expected seconds since the Unix epoch");
    }

    void noNumbersOverCbor() {
        FETCH(QByteArray, stamp, QByteArray, value, QString, refusal);
        raise();
        QVERIFY(panel_->board().add(field("vx")));
        subscribed("drive");
        const double now = stampNow();
        sayVx(now, 1);
        const DaemonLink *const daemon = window_->fleet.robot()->daemons().front();
        daemon_->say("drive", "{\"vx\":" + value + '}', stamp);
        QTRY_VERIFY2(daemon->reason().contains(refusal), qPrintable(daemon->reason()));
        QCOMPARE(daemon->condition(), Condition::Warning);
        sayVx(now + 2, 2); // the connection goes on
        QCOMPARE(samples("vx"), Samples({QPointF(now, 1), QPointF(now + 2, 2)}));
        const TopicSampler &sampler = panel_->board().sampler();
        QVERIFY(std::abs(sampler.now(sampler.clock(field("vx"))) - now) < 60);
        QVERIFY(!sampler.isRecorded(field("vx")));
        QVERIFY(!panel_->grab().isNull());
    }

    void manyTopicsAndLongNames() {
        close();
        Mischief many = drive();
        QByteArray topics = "[{\"name\":\"" + QByteArray(10000, 'W') + "\"}";
        for (int i = 0; i < 1000; ++i)
            topics += ",{\"name\":\"t" + QByteArray::number(i) + "\"}";
        many.results["rpc.discover"] = "{\"methods\":[],\"x-topics\":" + topics + "]}";
        open(many);
        raise();
        QTRY_COMPARE(tree_->topLevelItem(0)->childCount(), 200);
        QVERIFY(tree_->topLevelItem(0)->child(0)->text(0).size() < 100);
        QTRY_VERIFY(daemon_->subscriptions("t0") > 0); // measured, as it is seen
        QTest::qWait(600);
        int measured = 0;
        for (int i = 0; i < 1000; ++i)
            measured += daemon_->subscriptions(QString("t%1").arg(i));
        QVERIFY2(measured <= 60, qPrintable(QString::number(measured)));
        QVERIFY(window_->window.width() == 1280);
    }

    void goneDaemon() {
        raise();
        openTopic("drive");
        row("vx")->setCheckState(0, Qt::Checked);
        subscribed("drive");
        sayVx(stampNow(), 1);
        QVERIFY(window_->fleet.remove(window_->fleet.robot()).ok());
        QTest::qSleep(20); // as on a busy machine: its timers are due before what is gone is deleted
        QTRY_COMPARE(tree_->topLevelItemCount(), 0);
        QVERIFY(panel_->board().has(field("vx"))); // and what was sampled
        QCOMPARE(int(samples("vx").size()), 1);
        QVERIFY(window_->fleet.add(address_).ok()); // back again
        QTRY_COMPARE(tree_->topLevelItemCount(), 1);
        QTRY_VERIFY(daemon_->subscriptions("drive") > 3);
        sayVx(stampNow(), 2);
        QCOMPARE(row("vx")->checkState(0), Qt::Checked);
    }
};

QTEST_MAIN(TestPlottedStamps)
#include "TestPlottedStamps.moc"
