#include "tests/gui/desktop/LayoutWindow.h"

using namespace hermes;

/// Two windows, or a window and another program, with the same file: nothing that one keeps is lost by the
/// other.
class TestTwoWindows : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        folder_ = std::make_unique<QTemporaryDir>();
        file_ = folder_->filePath("new/gui.json");
        const auto one = opened();
        QTest::qWait(1500); // until all is kept as a window begins with it
        one->window->close();
        usual_ = contentOf(file_);
    }

    void init() {
        folder_ = std::make_unique<QTemporaryDir>();
        file_ = folder_->filePath("gui.json");
        put(file_, usual_);
    }

    void theFirstKeeps() {
        const auto first = opened();
        QCOMPARE(first->notice(), QString());
        auto second = opened();
        VERIFY_CONTAINS(second->notice(), "Another window keeps the layouts");
        QVERIFY(noteOf(*second).contains("Another window keeps the layouts") && noteOf(*first).isEmpty());
        first->saveAs("Precious");
        second->saveAs("Other");
        QTRY_VERIFY(kept().contains("Precious"));
        second->window->close();
        QVERIFY(!second->window->isVisible()); // it was said
        second.reset();
        QCOMPARE(kept(), QStringList({"Usual", "Precious"}));
        QCOMPARE(first->notice(), QString());
    }

    void theSecondTakesOver() {
        auto first = opened();
        QTest::qWait(1500); // until it has nothing to write
        const auto second = opened();
        second->saveAs("Mine");
        QTest::qWait(1000);
        QCOMPARE(kept(), QStringList("Usual"));
        first->window->close();
        first.reset();
        QTRY_VERIFY2_WITH_TIMEOUT(kept().contains("Mine"), qPrintable(noteOf(*second)), 15000);
        QTRY_VERIFY(noteOf(*second).isEmpty());
    }

    void theSecondLeavesWhatTheFirstChanged() {
        auto first = opened();
        auto second = opened();
        first->saveAs("Precious");
        QTRY_VERIFY(kept().contains("Precious"));
        first->window->close();
        first.reset();
        second->saveAs("Other");
        QTRY_VERIFY2_WITH_TIMEOUT(second->notice().contains("were changed by another window"),
                                  qPrintable(second->notice()), 15000);
        second->window->close();
        second.reset();
        QCOMPARE(kept(), QStringList({"Usual", "Precious"}));
    }

    void whatAnotherProgramWroteIsLeft() {
        auto one = opened();
        QTest::qWait(1000);
        Layouts other(file_);
        QVERIFY(other.saveAs("By hand").ok() && other.save().ok());
        one->saveAs("Mine");
        TRY_CONTAINS(one->notice(), "were changed by another");
        QVERIFY(noteOf(*one).contains("were changed by another"));
        one.reset();
        QCOMPARE(kept(), QStringList({"Usual", "By hand"}));
    }

private:
    std::unique_ptr<LayoutWindow> opened() const {
        return std::make_unique<LayoutWindow>(file_, QStringList("127.0.0.1:1"));
    }
    QStringList kept() const { return Layouts(file_).names(); }
    static QString noteOf(const LayoutWindow &one) {
        Q_EMIT one.menu().aboutToShow();
        auto *const note = one.menu().findChild<QAction *>("layoutsNotKept");
        return note ? note->text() : QString();
    }

    std::unique_ptr<QTemporaryDir> folder_;
    QString file_;
    QByteArray usual_; // what is kept as a window begins
};
