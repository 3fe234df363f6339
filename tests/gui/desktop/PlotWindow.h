#pragma once

#include "gui/desktop/panels/PlotsPanel.h"
#include "gui/desktop/panels/TopicTree.h"
#include "tests/gui/desktop/FakeDaemon.h"
#include "tests/gui/desktop/OpenWindow.h"

namespace hermes {

/// The window on a daemon that says what a test wants, and its plots.
class PlotWindow {
protected:
    /// A topic "drive" with velocities, a voltage and a list.
    static Mischief drive() {
        Mischief mischief;
        mischief.results["rpc.discover"] =
            R"({"methods":[{"name":"daemon.info"}],"x-topics":[{"name":"drive","schema":{"type":"object",
            "properties":{"vx":{"type":"number","unit":"m/s"},"vy":{"type":"number","unit":"m/s"},
            "battery":{"type":"number","unit":"V"},"list":{"type":"array","items":{"type":"number"}}}}}]})";
        mischief.results["rpc.discover"].replace('\n', ' ');
        return mischief;
    }
    void open(const Mischief &mischief) {
        daemon_ = std::make_unique<FakeDaemon>(mischief);
        address_ = daemon_->address();
        window_ = std::make_unique<OpenWindow>();
        QVERIFY(window_->show());
        QVERIFY(window_->fleet.add(address_).ok());
        panel_ = window_->window.findChild<PlotsPanel *>();
        tree_ = panel_->findChild<TopicTree *>();
        QTRY_VERIFY(tree_->topLevelItemCount() == 1);
    }
    void close() {
        window_.reset();
        daemon_.reset();
    }
    QTreeWidgetItem *row(const QString &name) const {
        return tree_->findItems(name, Qt::MatchExactly | Qt::MatchRecursive).value(0);
    }
    void raise() { QCOMPARE(window_->panel<PlotsPanel>("plots"), panel_); }
    void openTopic(const QString &name) {
        QVERIFY(row(name));
        row(name)->setExpanded(true);
    }
    FieldId field(const QString &path) const { return {address_, "drive", path}; }
    const Samples &samples(const QString &path) const {
        return panel_->board().sampler().samples(field(path));
    }
    /// Until it has come: what comes faster is thinned.
    void say(double stamp, const QByteArray &data, const QString &path = "vx") {
        const Samples &kept = samples(path);
        const QPointF before = kept.empty() ? QPointF() : kept.back();
        daemon_->say("drive", data, QByteArray::number(stamp, 'f', 3));
        QTRY_VERIFY(!kept.empty() && kept.back() != before);
        QTest::qWait(60);
    }
    void sayVx(double stamp, double vx) { say(stamp, "{\"vx\":" + QByteArray::number(vx) + '}'); }
    void subscribed(const QString &topic) { QTRY_VERIFY(daemon_->subscriptions(topic) > 1); }

    std::unique_ptr<FakeDaemon> daemon_;
    std::unique_ptr<OpenWindow> window_;
    QString address_;
    PlotsPanel *panel_ = nullptr;
    TopicTree *tree_ = nullptr;
};

} // namespace hermes
