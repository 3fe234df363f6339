#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QPointer>
#include <QWidget>

class QLineEdit;
class QPushButton;

namespace hermes::desktop {

class MessageLabel;
class PlainLabel;
class SchemaForm;

/// The settings of the chosen daemon, made from its own schema: apply, revert, defaults, save.
class SettingsPanel : public QWidget {
    Q_OBJECT
public:
    explicit SettingsPanel(Fleet &fleet, QWidget *parent = nullptr);

private:
    void follow(DaemonLink *daemon);
    void load();
    void apply();
    void save();
    void update();
    QWidget *makeButtons();

    QPointer<DaemonLink> daemon_;
    int handle_ = 0; // subscription to the topic "settings"
    PlainLabel *title_;
    MessageLabel *message_;
    QLineEdit *filter_;
    SchemaForm *form_;
    QPushButton *apply_, *revert_, *defaults_, *save_;
};

} // namespace hermes::desktop
