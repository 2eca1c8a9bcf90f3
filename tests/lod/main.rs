//! Choosing and changing levels of detail in a scene: criteria, hysteresis, transitions and budgets.

mod budgets;
mod characters;
mod criteria;
mod foreign;
mod joined;
mod linear;
mod promise;
mod stage;
mod transitions;
