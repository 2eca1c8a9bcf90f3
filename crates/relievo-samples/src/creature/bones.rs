//! Skeleton of the creature: roles, names and rest transforms of the bones.

use relievo::asset::transform::Transform;

/// Left or right side of the body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    Left,
    Right,
}

impl Side {
    const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// Sign of x on this side: +1 on the left, −1 on the right.
    pub fn sign(self) -> f64 {
        if self == Self::Left { 1.0 } else { -1.0 }
    }
}

/// Role of a bone in the body. Within a chain of bones, numbers count from the trunk outwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Root,
    Pelvis,
    Spine(usize),
    Crest(usize),
    Belly(usize),
    Neck(usize),
    Head,
    Jaw,
    Tongue(usize),
    Eye(Side),
    Ear(Side, usize),
    Feeler(Side, usize),
    Clavicle(Side),
    UpperArm(Side),
    UpperArmTwist(Side),
    Forearm(Side),
    ForearmTwist(Side),
    Hand(Side),
    Finger(Side, usize, usize),
    Thigh(Side),
    ThighTwist(Side),
    Shin(Side),
    ShinTwist(Side),
    Foot(Side),
    Toe(Side, usize, usize),
    Tail(usize),
}

impl Kind {
    /// Name of the bone: the variant and its fields in snake case, such as `finger_left_0_1`.
    pub fn name(self) -> String {
        let mut name = String::new();
        for letter in format!("{self:?}").chars() {
            match letter {
                'A'..='Z' if !name.is_empty() && !name.ends_with('_') => {
                    name.extend(['_', letter.to_ascii_lowercase()]);
                }
                '(' | ',' => name.push('_'),
                ')' | ' ' => {}
                _ => name.push(letter.to_ascii_lowercase()),
            }
        }
        name
    }
}

/// A bone with its role, parent and rest transform.
pub struct Part {
    pub kind: Kind,
    pub parent: Option<u32>,
    pub rest: Transform,
}

/// All bones of the creature, in depth-first order.
pub fn parts() -> Vec<Part> {
    let mut body = Body(Vec::with_capacity(153));
    let root = body.add(Kind::Root, None, [0.0; 3]);
    let pelvis = body.add(Kind::Pelvis, Some(root), [0.0, 0.95, 0.0]);
    let mut spine = pelvis;
    for at in 0..6 {
        spine = body.add(Kind::Spine(at), Some(spine), [0.0, 0.085, if at < 3 { 0.01 } else { -0.01 }]);
        body.add(Kind::Crest(at), Some(spine), [0.0, 0.02, -0.12]);
        if at < 4 {
            body.add(Kind::Belly(at), Some(spine), [0.0, 0.0, 0.11]);
        }
    }
    body.head(spine);
    Side::BOTH.iter().for_each(|side| body.arm(*side, spine));
    Side::BOTH.iter().for_each(|side| body.leg(*side, pelvis));
    let mut tail = pelvis;
    for at in 0..18 {
        let length = 0.07 - 0.002 * at as f32;
        let offset = if at == 0 { [0.0, -0.02, -0.1] } else { [0.0, -0.35 * length, -length] };
        tail = body.add(Kind::Tail(at), Some(tail), offset);
    }
    body.0
}

struct Body(Vec<Part>);

impl Body {
    fn add(&mut self, kind: Kind, parent: Option<u32>, translation: [f32; 3]) -> u32 {
        self.0.push(Part { kind, parent, rest: Transform::from_translation(translation) });
        self.0.len() as u32 - 1
    }

    /// Adds a chain of `count` bones and returns the last one. The first bone is at `first` in the space of `parent`; every other
    /// bone is at `next` in the space of the bone before.
    fn chain(
        &mut self,
        parent: u32,
        count: usize,
        kind: impl Fn(usize) -> Kind,
        [first, next]: [[f32; 3]; 2],
    ) -> u32 {
        (0..count)
            .fold(parent, |parent, at| self.add(kind(at), Some(parent), if at == 0 { first } else { next }))
    }

    fn head(&mut self, chest: u32) {
        let neck = self.chain(chest, 3, Kind::Neck, [[0.0, 0.07, 0.0], [0.0, 0.045, 0.005]]);
        let head = self.add(Kind::Head, Some(neck), [0.0, 0.05, 0.01]);
        let jaw = self.add(Kind::Jaw, Some(head), [0.0, -0.01, 0.05]);
        self.chain(jaw, 4, Kind::Tongue, [[0.0, 0.005, 0.01], [0.0, 0.0, 0.02]]);
        for side in Side::BOTH {
            let x = side.sign() as f32;
            self.add(Kind::Eye(side), Some(head), [0.035 * x, 0.06, 0.09]);
            let ear = [[0.07 * x, 0.12, -0.02], [0.02 * x, 0.045, -0.01]];
            self.chain(head, 3, |at| Kind::Ear(side, at), ear);
            let feeler = [[0.02 * x, 0.15, 0.07], [0.012 * x, 0.035, 0.03]];
            self.chain(head, 4, |at| Kind::Feeler(side, at), feeler);
        }
    }

    fn arm(&mut self, side: Side, chest: u32) {
        let x = side.sign() as f32;
        let clavicle = self.add(Kind::Clavicle(side), Some(chest), [0.03 * x, 0.02, 0.02]);
        let upper = self.add(Kind::UpperArm(side), Some(clavicle), [0.15 * x, 0.0, -0.02]);
        // At rest the arms hang down.
        self.0[upper as usize].rest.rotation = turn([0.0, 0.0, 1.0], -1.25 * side.sign()).map(|v| v as f32);
        self.add(Kind::UpperArmTwist(side), Some(upper), [0.14 * x, 0.0, 0.0]);
        let forearm = self.add(Kind::Forearm(side), Some(upper), [0.28 * x, 0.0, 0.0]);
        self.add(Kind::ForearmTwist(side), Some(forearm), [0.13 * x, 0.0, 0.0]);
        let hand = self.add(Kind::Hand(side), Some(forearm), [0.26 * x, 0.0, 0.0]);
        for digit in 0..5 {
            let z = 0.04 - 0.02 * digit as f32;
            let length = if digit == 0 { 0.025 } else { 0.032 };
            let finger = [[if digit == 0 { 0.02 } else { 0.03 } * x, 0.0, z], [length * x, 0.0, 0.0]];
            self.chain(hand, 4, |at| Kind::Finger(side, digit, at), finger);
        }
    }

    fn leg(&mut self, side: Side, pelvis: u32) {
        let x = side.sign() as f32;
        let thigh = self.add(Kind::Thigh(side), Some(pelvis), [0.1 * x, -0.03, 0.0]);
        self.add(Kind::ThighTwist(side), Some(thigh), [0.0, -0.21, 0.0]);
        let shin = self.add(Kind::Shin(side), Some(thigh), [0.0, -0.42, 0.01]);
        self.add(Kind::ShinTwist(side), Some(shin), [0.0, -0.2, 0.0]);
        let foot = self.add(Kind::Foot(side), Some(shin), [0.0, -0.41, -0.01]);
        for digit in 0..5 {
            let sideways = (0.03 - 0.015 * digit as f32) * x;
            let toe = [[sideways, -0.06, 0.13], [0.0, -0.002, 0.02]];
            self.chain(foot, 3, |at| Kind::Toe(side, digit, at), toe);
        }
    }
}

/// Quaternion (x, y, z, w) of a rotation by `angle` radians about a unit axis.
pub fn turn(axis: [f64; 3], angle: f64) -> [f64; 4] {
    let (sine, cosine) = (libm::sin(angle / 2.0), libm::cos(angle / 2.0));
    [axis[0] * sine, axis[1] * sine, axis[2] * sine, cosine]
}
