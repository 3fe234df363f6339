#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QPointer>
#include <QTimer>
#include <QWidget>

class QLineEdit;
class QListWidget;
class QPlainTextEdit;
class QPushButton;

namespace hermes::desktop {

class PlainLabel;
class SchemaForm;

/// Any method of the chosen daemon: a form for its parameters, a call, the answer. What replaces or forgets
/// something needs a second press.
class CommandsPanel : public QWidget {
    Q_OBJECT
public:
    explicit CommandsPanel(Fleet &fleet, QWidget *parent = nullptr);

private:
    void follow(DaemonLink *daemon);
    void listMethods();
    void showMethod(const QString &name);
    void call();
    void update();
    QWidget *makeMethods();
    QWidget *makeCall();

    Fleet &fleet_;
    QPointer<DaemonLink> daemon_;
    PlainLabel *title_, *summary_;
    QLineEdit *filter_;
    QListWidget *methods_;
    SchemaForm *form_;
    QPushButton *call_;
    QPlainTextEdit *answer_;
    QString method_; ///< empty: none is chosen
    QTimer asked_;   ///< while a second press of Run is waited for
};

} // namespace hermes::desktop
