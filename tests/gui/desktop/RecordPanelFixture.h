#pragma once

#include "gui/desktop/model/Fleet.h"
#include "gui/desktop/panels/RecordPanel.h"
#include "tests/gui/FakeLogger.h"

namespace hermes {

using namespace desktop;

/// The panel of recordings alone, with its fleet.
class RecordPanelFixture {
protected:
    void open(Fleet &fleet, const QStringList &loggers) {
        panel_ = std::make_unique<RecordPanel>(fleet);
        panel_->show();
        for (const QString &logger : loggers)
            QTRY_VERIFY(text("amount").contains(logger));
    }
    void open(Fleet &fleet, FakeLoggers &robot) {
        QStringList names;
        for (const auto &logger : robot.loggers) {
            QVERIFY(fleet.add(logger->address().section("//", -1)).ok());
            names.append(logger->info().name);
        }
        open(fleet, names);
    }
    template <typename T>
    T *find(const QString &name) const {
        return panel_->findChild<T *>(name);
    }
    QString text(const QString &label) const { return find<QLabel>(label)->text(); }
    QString button(const QString &name) const { return find<QPushButton>(name)->text(); }
    void click(const QString &button) { QTest::mouseClick(find<QPushButton>(button), Qt::LeftButton); }

    std::unique_ptr<RecordPanel> panel_;
};

} // namespace hermes
