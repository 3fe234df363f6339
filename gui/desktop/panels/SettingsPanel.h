#pragma once

#include "gui/desktop/model/Fleet.h"

#include <QPointer>
#include <QWidget>

class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;

namespace hermes {

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
    void tell(const QString &text, bool isError);
    QWidget *makeButtons();

    QPointer<DaemonLink> daemon_;
    int handle_ = 0; // subscription to the topic "settings"
    QLabel *title_, *message_;
    QLineEdit *filter_;
    SchemaForm *form_;
    QPushButton *apply_, *revert_, *defaults_, *save_;
};

} // namespace hermes
