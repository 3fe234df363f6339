#pragma once

#include "gui/desktop/widgets/SchemaForm.h"

namespace hermes {

using namespace desktop;

/// A form in a window of its own, and hands that click and type in it.
class OpenForm {
public:
    OpenForm() {
        area_.resize(900, 500);
        area_.setWidgetResizable(true);
        area_.setWidget(form_ = new SchemaForm);
    }

    SchemaForm &form() { return *form_; }
    QScrollArea &window() { return area_; }
    /// Shows the window, with whatever is in it.
    void show() {
        area_.show();
        area_.activateWindow();
        QVERIFY(QTest::qWaitForWindowActive(&area_));
    }
    /// A form with one value, "a".
    void showOne(const QByteArray &schema, const QByteArray &value = {}, const QByteArray &more = {}) {
        const QByteArray whole = R"({"type":"object","properties":{"a":)" + schema + '}' + more + '}';
        const QJsonObject made = QJsonDocument::fromJson(whole).object();
        QVERIFY2(!made.isEmpty(), whole.constData());
        form_->setSchema(made, value.isEmpty() ? QJsonObject() : object(R"({"a":)" + value + '}'));
        show();
    }
    static QJsonObject object(const QByteArray &json) { return QJsonDocument::fromJson(json).object(); }
    /// As JSON; empty: absent.
    QByteArray value() const {
        const QJsonObject values = form_->values();
        if (!values.contains("a"))
            return {};
        const QByteArray list = QJsonDocument(QJsonArray{values["a"]}).toJson(QJsonDocument::Compact);
        return list.mid(1, list.size() - 2);
    }
    QString note(const QString &path = "a") const {
        return form_->findChild<QLabel *>(path + "/note")->text();
    }
    /// The nth of those that are to be seen.
    template <typename T>
    T *seen(int n = 0, const QString &name = {}) const {
        QCoreApplication::sendPostedEvents(); // what is new is shown with them
        for (T *const found : form_->findChildren<T *>(name))
            if (found->isVisible() && n-- == 0)
                return found;
        return nullptr;
    }
    void click(const QString &name, int n = 0) {
        QWidget *button = nullptr;
        QTRY_VERIFY2((button = seen<QAbstractButton>(n, name)) && button->isEnabled(), qPrintable(name));
        area_.ensureWidgetVisible(button);
        QTest::mouseClick(button, Qt::LeftButton);
    }
    static void type(QLineEdit *line, const QString &text) {
        QVERIFY(line);
        QTest::mouseClick(line, Qt::LeftButton);
        line->selectAll();
        QTest::keyClick(line, Qt::Key_Delete);
        QTest::keyClicks(line, text);
    }
    void addField(const QString &title, int n) {
        auto *const button = seen<QPushButton>(n, "addField");
        QVERIFY(button && button->isEnabled());
        QMenu *const menu = button->menu();
        for (QAction *const action : menu->actions())
            if (action->text() == title) {
                menu->popup(button->mapToGlobal({}));
                QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
                return;
            }
        QFAIL(qPrintable(title));
    }

private:
    QScrollArea area_;
    SchemaForm *form_ = nullptr;
};

} // namespace hermes
