//! The camera: what mouse and keys do to it.

use std::collections::HashSet;

use glam::Vec3;
use winit::event::MouseScrollDelta;
use winit::keyboard::KeyCode;

/// Radians that a drag over the window's height turns.
const TURN: f32 = 2.5;

/// World units a second.
const SPEED: f32 = 20.0;

/// A camera that goes around a point, or stands in it. Until it is first touched, it turns slowly.
pub struct Eye {
    /// The point that it goes around; keys move it.
    focus: Vec3,
    /// Its distance to that point. At 0, dragging looks around instead.
    distance: f32,
    /// In radians: 0 looks north (−Z), growing to the left.
    yaw: f32,
    /// In radians, above the horizon.
    pitch: f32,
    is_touched: bool,
    held: HashSet<KeyCode>,
    is_dragging: bool,
    cursor: Option<[f64; 2]>,
}

impl Default for Eye {
    fn default() -> Self {
        Self {
            focus: Vec3::new(64.0, 4.0, 64.0),
            distance: 60.0,
            yaw: 0.5,
            pitch: -0.35,
            is_touched: false,
            held: HashSet::new(),
            is_dragging: false,
            cursor: None,
        }
    }
}

impl Eye {
    /// The unit vector ahead.
    pub fn ahead(&self) -> Vec3 {
        let (sin, cos) = self.yaw.sin_cos();
        let level = self.pitch.cos();
        Vec3::new(-sin * level, self.pitch.sin(), -cos * level)
    }

    /// Where it stands in the world.
    pub fn position(&self) -> Vec3 {
        self.focus - self.distance * self.ahead()
    }

    /// A key was pressed or released.
    pub fn key(&mut self, key: KeyCode, is_pressed: bool) {
        self.is_touched = true;
        if is_pressed {
            self.held.insert(key);
        } else {
            self.held.remove(&key);
        }
    }

    /// The left button was pressed or released.
    pub fn button(&mut self, is_pressed: bool) {
        self.is_touched = true;
        self.is_dragging = is_pressed;
    }

    /// Nothing is held any more: another window gets the events.
    pub fn release(&mut self) {
        self.held.clear();
        self.is_dragging = false;
    }

    /// The cursor moved to a position, from the top left corner, in heights of the window.
    pub fn cursor(&mut self, to: [f64; 2]) {
        if let Some(from) = self.cursor.replace(to).filter(|_| self.is_dragging) {
            let [right, down] = [0, 1].map(|axis| (to[axis] - from[axis]) as f32 * TURN);
            self.yaw -= right;
            self.pitch = (self.pitch - down).clamp(-1.5, 1.5);
        }
    }

    /// The wheel turned.
    pub fn wheel(&mut self, delta: MouseScrollDelta) {
        let lines = match delta {
            MouseScrollDelta::LineDelta(_, lines) => lines,
            MouseScrollDelta::PixelDelta(pixels) => pixels.y as f32 / 40.0,
        };
        self.is_touched = true;
        let distance = self.distance.max(1.0) * 0.9_f32.powf(lines);
        self.distance = if distance < 1.0 { 0.0 } else { distance.min(500.0) };
    }

    /// Moves it for so many seconds, as the keys that are held say.
    pub fn advance(&mut self, seconds: f32) {
        if !self.is_touched {
            self.yaw += 0.1 * seconds;
        }
        let pressed = |key| if self.held.contains(&key) { 1.0 } else { 0.0 };
        let along = |to, from| pressed(to) - pressed(from);
        let (ahead, right) = (self.ahead(), self.ahead().cross(Vec3::Y).normalize_or_zero());
        let way = ahead * along(KeyCode::KeyW, KeyCode::KeyS)
            + right * along(KeyCode::KeyD, KeyCode::KeyA)
            + Vec3::Y * along(KeyCode::KeyE, KeyCode::KeyQ);
        let factor = 1.0 + 3.0 * pressed(KeyCode::ShiftLeft);
        self.focus += way * (SPEED * factor * seconds);
    }
}
