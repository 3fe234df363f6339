#include "gui/desktop/Theme.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/PlainLabel.h"
#include "tests/gui/desktop/OpenWindow.h"

#include <QDirIterator>
#include <QHelpEvent>
#include <QLayout>
#include <QStyleOptionComboBox>

using namespace hermes;

static const QRegularExpression &foreignWords() {
    static const QRegularExpression words(
        "\\b(socket|(?<!\\.)JSON|CBOR|RPC|null|payload|schema|tcp://"
        "|stderr|errno|boolean|OpenGL|lease|latched|"
        "systemctl|endpoint|callback|handshake|thread|HOST:PORT)\\b|settings\\.(get|schema)|rpc\\.",
        QRegularExpression::CaseInsensitiveOption);
    return words;
}

static QString nameOf(const QWidget &widget, const QString &text) {
    QString path = widget.objectName();
    for (const QWidget *above = widget.parentWidget(); above && path.count('/') < 3;
         above = above->parentWidget())
        path.prepend(
            (above->objectName().isEmpty() ? above->metaObject()->className() : above->objectName()) + '/');
    return QString("%1 %2 \"%3\" (%4 x %5)")
        .arg(widget.metaObject()->className(), path, text)
        .arg(widget.width())
        .arg(widget.height());
}

static int widthOf(const QWidget &widget, const QString &text) {
    return widget.fontMetrics().size(Qt::TextShowMnemonic, text).width();
}

static QString shownToolTip(QWidget &widget) {
    const QPoint middle = widget.rect().center();
    QHelpEvent asks(QEvent::ToolTip, middle, widget.mapToGlobal(middle));
    QApplication::sendEvent(&widget, &asks);
    return QToolTip::text();
}

static bool fits(QLabel &label) {
    if (auto *const plain = qobject_cast<PlainLabel *>(&label); plain && plain->isElided())
        return shownToolTip(label).contains(label.text().toHtmlEscaped());
    const QRect room = label.contentsRect();
    return label.wordWrap() ? label.heightForWidth(label.width()) <= label.height()
                            : widthOf(label, label.text()) <= room.width();
}

static bool fits(const QHeaderView &header, int section) {
    const auto *const model = header.model();
    const QString text = model->headerData(section, Qt::Horizontal).toString();
    const int arrow =
        header.isSortIndicatorShown() && header.sortIndicatorSection() == section ? header.height() / 2 : 0;
    return text.isEmpty() || header.isSectionHidden(section) ||
           widthOf(header, text) + arrow <= header.sectionSize(section);
}

static bool fits(const QTabBar &bar, int tab) {
    return bar.tabRect(tab).right() < bar.width() &&
           widthOf(bar, bar.tabText(tab)) <= bar.tabRect(tab).width();
}

static bool fits(const QComboBox &list) {
    QStyleOptionComboBox option;
    option.initFrom(&list);
    const QRect room =
        list.style()->subControlRect(QStyle::CC_ComboBox, &option, QStyle::SC_ComboBoxEditField);
    return widthOf(list, list.currentText()) <= room.width() || list.toolTip().contains(list.currentText());
}

/// What of this window does not fit, in words.
static QStringList tooNarrow(MainWindow &window) {
    QStringList found;
    for (QWidget *widget : window.findChildren<QWidget *>()) {
        if (widget->visibleRegion().isEmpty())
            continue;
        if (auto *const label = qobject_cast<QLabel *>(widget); label && !fits(*label))
            found.append(nameOf(*label, label->text()));
        if (auto *const button = qobject_cast<QAbstractButton *>(widget);
            button && !button->text().isEmpty() && button->width() < widthOf(*button, button->text()) &&
            !button->toolTip().contains(button->text().toHtmlEscaped()))
            found.append(nameOf(*button, button->text()));
        if (auto *const list = qobject_cast<QComboBox *>(widget); list && !fits(*list))
            found.append(nameOf(*list, list->currentText()));
        if (auto *const bar = qobject_cast<QTabBar *>(widget))
            for (int tab = 0; tab < bar->count(); ++tab)
                if (!fits(*bar, tab))
                    found.append(nameOf(*bar, bar->tabText(tab)));
        if (auto *const header = qobject_cast<QHeaderView *>(widget);
            header && header->orientation() == Qt::Horizontal)
            for (int section = 0; section < header->count(); ++section)
                if (!fits(*header, section))
                    found.append(
                        nameOf(*header, header->model()->headerData(section, Qt::Horizontal).toString()));
        if (auto *const area = qobject_cast<QScrollArea *>(widget);
            area && area->widget() && area->widget()->width() > area->viewport()->width())
            found.append(nameOf(*area, "wider than its room"));
    }
    return found;
}

static QStringList overlapping(MainWindow &window) {
    QStringList found;
    for (const QLayout *layout : window.findChildren<QLayout *>()) {
        QList<QWidget *> widgets;
        for (int i = 0; i < layout->count(); ++i)
            if (QWidget *const widget = layout->itemAt(i)->widget(); widget && widget->isVisible())
                for (const QWidget *other : qAsConst(widgets))
                    if (widget->parent() == other->parent() &&
                        widget->geometry().intersects(other->geometry()))
                        found.append(nameOf(*widget, "over " + other->objectName()));
        for (int i = 0; i < layout->count(); ++i)
            if (QWidget *const widget = layout->itemAt(i)->widget())
                widgets.append(widget);
    }
    return found;
}

static double luminance(const QColor &colour) {
    const auto linear = [](double part) {
        return part <= 0.03928 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(colour.redF()) + 0.7152 * linear(colour.greenF()) +
           0.0722 * linear(colour.blueF());
}

/// As WCAG 2 defines it.
static double contrast(const QColor &one, const QColor &other) {
    const double a = luminance(one), b = luminance(other);
    return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

/// Every text of the window is seen whole or has a tool tip with the rest, stands out, and is in words of an
/// operator. The theme is that of HERMES_THEME, the scale that of QT_SCALE_FACTOR.
class TestReadable : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void initTestCase() {
        theme::apply();
        robot_ = std::make_unique<RobotProcesses>();
        robot_->startAll();
    }

    void textsFit_data() {
        const Rows<QSize> row("size");
        row("1024 x 600", QSize(1024, 600));
        row("1920 x 1080", QSize(1920, 1080));
    }

    void textsFit() {
        QFETCH(const QSize, size);
        OpenWindow open(*robot_);
        QVERIFY(open.show());
        open.window.resize(size);
        QTRY_VERIFY_WITH_TIMEOUT(open.fleet.robot() && open.drive.isPossible(), 20000);
        QTRY_VERIFY_WITH_TIMEOUT(open.fleet.robot()->withName("scanmatcher"), 20000);
        open.fleet.choose(open.fleet.robot()->withName("scanmatcher"));
        QStringList found;
        for (auto *const dock : open.window.findChildren<QDockWidget *>()) {
            dock->raise();
            QTRY_VERIFY2(open.window.rect().contains(dock->geometry()), qPrintable(dock->objectName()));
            QCoreApplication::sendPostedEvents();
            found += tooNarrow(open.window) + overlapping(open.window);
        }
        found.removeDuplicates();
        QVERIFY2(open.window.size() == size, saying("%1", open.window.height()));
        QVERIFY2(found.isEmpty(), qPrintable(found.join('\n')));
    }

    void whatDrivesIsInSight() {
        OpenWindow open(*robot_);
        QVERIFY(open.show());
        open.window.resize(1024, 600);
        QTRY_VERIFY_WITH_TIMEOUT(open.drive.isPossible(), 20000);
        Client other;
        other.connectTo(QString("127.0.0.1:%1").arg(robot_->port("motorcontrol")));
        QTRY_VERIFY(other.isConnected());
        QJsonObject anna{{"client", "anna on laptop7"}};
        QVERIFY(other.callAndWait("motor.estop", anna).ok());
        QTRY_VERIFY_WITH_TIMEOUT(open.drive.isStopped(), 10000);
        auto *const banner = open.window.findChild<QToolBar *>("stopLine");
        QTRY_VERIFY(banner->isVisible());
        QCOMPARE(open.window.size(), QSize(1024, 600)); // with a banner, too
        QVERIFY(releaseStop(other, anna));
        QTRY_VERIFY_WITH_TIMEOUT(!banner->isVisible(), 10000);
        anna["timeout_s"] = 60; // she does not drive
        QVERIFY(other.callAndWait("control.acquire", anna).ok());
        auto *const takeOver = open.window.findChild<QWidget *>("takeOver");
        QTRY_VERIFY_WITH_TIMEOUT(takeOver->isVisible(), 10000);
        for (const char *const name : {"stop", "stick", "speedLimit", "limit", "turnLimit", "measured0",
                                       "measured2", "commanded0", "takeOver"}) {
            auto *const widget = open.window.findChild<QWidget *>(name);
            QTRY_VERIFY2(widget->visibleRegion().boundingRect() == widget->rect(), name);
        }
    }

    void coloursStandOut() {
        OpenWindow open;
        QVERIFY(open.show());
        constexpr double least = 4.5;
        const QPalette palette = QApplication::palette();
        for (const auto condition : {Condition::Ready, Condition::Busy, Condition::Warning, Condition::Fault,
                                     Condition::Unreachable})
            for (const auto role : {QPalette::Window, QPalette::Base})
                QVERIFY2(contrast(theme::colour(condition), palette.color(role)) >= least,
                         qPrintable(QString("%1 on %2: %3")
                                        .arg(theme::colour(condition).name(), palette.color(role).name())
                                        .arg(contrast(theme::colour(condition), palette.color(role)))));
        for (const QWidget *widget : open.window.findChildren<QWidget *>()) {
            const bool isText = qobject_cast<const QLabel *>(widget) ||
                                qobject_cast<const QAbstractButton *>(widget) ||
                                qobject_cast<const QLineEdit *>(widget);
            if (!isText || !widget->isEnabled() || !widget->styleSheet().isEmpty())
                continue;
            const QColor front = widget->palette().color(widget->foregroundRole()),
                         back = widget->palette().color(widget->backgroundRole());
            QVERIFY2(contrast(front, back) >= least,
                     qPrintable(nameOf(*widget, front.name() + " on " + back.name())));
        }
    }

    // As it is painted: colours of a palette may come out otherwise.
    void quietTextIsPainted() {
        PlainLabel label("What a setting means");
        label.setForegroundRole(QPalette::PlaceholderText);
        label.resize(label.sizeHint());
        const QImage picture = label.grab().toImage();
        double best = 1;
        for (int x = 0; x < picture.width(); ++x)
            for (int y = 0; y < picture.height(); ++y)
                best = std::max(best, contrast(picture.pixelColor(x, y), picture.pixelColor(0, 0)));
        QVERIFY2(best >= 3.5, saying(best));
    }

    /// All that the sources give to tr(), with what the window shows at first.
    void wordsAreOfAnOperator() {
        static const QRegularExpression told("\\btr\\(\\s*((?:\"(?:[^\"\\\\]|\\\\.)*\"\\s*)+)");
        QDirIterator files(qEnvironmentVariable("HERMES_SOURCE") + "/gui/desktop", {"*.cpp", "*.h"},
                           QDir::Files, QDirIterator::Subdirectories);
        QStringList found;
        int texts = 0;
        while (files.hasNext()) {
            for (auto all = told.globalMatch(QString::fromUtf8(contentOf(files.next()))); all.hasNext();
                 ++texts)
                if (const QString text = all.next().captured(1); text.contains(foreignWords()))
                    found.append(files.fileName() + ": " + text);
        }
        QVERIFY2(texts > 400, saying(texts));
        OpenWindow open;
        for (const QWidget *widget : open.window.findChildren<QWidget *>())
            for (const QString &text : {widget->toolTip(), widget->property("text").toString(),
                                        widget->property("placeholderText").toString()})
                if (text.contains(foreignWords()))
                    found.append(nameOf(*widget, text));
        QVERIFY2(found.isEmpty(), qPrintable(found.join('\n')));
    }

    void wordsOfDaemonsAreMadePlain() {
        QCOMPARE(inPlainWords("stop by anna, tcp://10.0.0.2:4711 (user root); motor.reset_estop releases it"),
                 QString("stop by anna, 10.0.0.2:4711 (user root); Release ends it"));
        QCOMPARE(inPlainWords("no answer of tcp://10.0.0.2:7410?protocol=json: refused"),
                 QString("no answer of 10.0.0.2:7410: refused"));
    }

private:
    std::unique_ptr<RobotProcesses> robot_;
};
