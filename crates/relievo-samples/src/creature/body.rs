//! Mesh of the creature: closed tubes around chains of bones. It has about 5,000 vertices, each with up to four influences.

use std::collections::HashMap;

use glam::DVec3;
use relievo::InputError;
use relievo::asset::Mesh;
use relievo::asset::influences::{Influence, Influences};
use relievo::asset::mesh::solved_tangents;

use super::bones::{Kind, Part, Side};
use super::tube::{Section, Surface, Tube};

/// Largest number of bones that may influence a vertex.
const MAX: usize = 4;

/// Builds the creature's mesh for a skin of all bones. `positions` are the bones' positions at rest, in the model's space.
///
/// # Errors
/// Never fails in practice: the mesh is checked like any other mesh.
pub fn body(parts: &[Part], positions: &[DVec3]) -> Result<Mesh, InputError> {
    let mut body = Body { parts, positions, surface: Surface::default() };
    body.trunk();
    body.head();
    for side in [Side::Left, Side::Right] {
        body.arm(side);
        body.leg(side);
    }
    body.tail();
    mesh(body.surface, parts.len())
}

struct Body<'a> {
    parts: &'a [Part],
    positions: &'a [DVec3],
    surface: Surface,
}

impl Body<'_> {
    fn bone(&self, kind: Kind) -> u32 {
        self.parts.iter().position(|part| part.kind == kind).unwrap_or_default() as u32
    }

    fn position(&self, kind: Kind) -> DVec3 {
        self.positions[self.bone(kind) as usize]
    }

    /// Cross-section of a tube near the joint of a bone. `offset` is from the joint, in the model's axes.
    fn section(&self, kind: Kind, offset: [f64; 3], radii: [f64; 2]) -> Section {
        Section { center: self.position(kind) + DVec3::from(offset), radii, bone: self.bone(kind) }
    }

    fn tube(&mut self, sections: &[Section], reference: DVec3, [sides, rings, cap]: [usize; 3], blend: f64) {
        self.surface.add(&Tube { sections, reference, sides, rings, cap, blend });
    }

    /// Adds a tube around a chain of thin bones. It begins inside the body, at the first joint minus `inside`, and ends at the
    /// last joint plus `beyond`.
    fn shoot(
        &mut self,
        kinds: &[Kind],
        [inside, beyond]: [DVec3; 2],
        radii: &[[f64; 2]],
        [sides, rings]: [usize; 2],
    ) {
        let above = self.parts[self.bone(kinds[0]) as usize].parent.unwrap_or_default();
        let reference =
            if inside.cross(DVec3::Z).length() > 0.5 * inside.length() { DVec3::Z } else { DVec3::Y };
        let mut sections =
            vec![Section { center: self.position(kinds[0]) - inside, radii: radii[0], bone: above }];
        let last = radii[radii.len() - 1];
        sections.extend(kinds.iter().zip(radii).map(|(kind, radii)| self.section(*kind, [0.0; 3], *radii)));
        let tip = kinds[kinds.len() - 1];
        sections.push(self.section(tip, beyond.to_array(), last.map(|radius| 0.6 * radius)));
        self.tube(&sections, reference, [sides, rings, 2], 0.5 * beyond.length().max(0.02));
    }

    fn trunk(&mut self) {
        let spine = |at| Kind::Spine(at);
        let neck = |at| Kind::Neck(at);
        let sections = [
            self.section(Kind::Pelvis, [0.0, -0.07, 0.0], [0.11, 0.085]),
            self.section(Kind::Pelvis, [0.0; 3], [0.155, 0.115]),
            self.section(spine(0), [0.0; 3], [0.145, 0.115]),
            self.section(spine(1), [0.0; 3], [0.132, 0.11]),
            self.section(spine(2), [0.0; 3], [0.135, 0.11]),
            self.section(spine(3), [0.0; 3], [0.15, 0.115]),
            self.section(spine(4), [0.0; 3], [0.165, 0.12]),
            self.section(spine(5), [0.0; 3], [0.145, 0.1]),
            self.section(neck(0), [0.0; 3], [0.065, 0.062]),
            self.section(neck(1), [0.0; 3], [0.052, 0.055]),
            self.section(neck(2), [0.0; 3], [0.052, 0.055]),
            self.section(Kind::Head, [0.0; 3], [0.05, 0.055]),
        ];
        let first = self.surface.positions.len();
        self.tube(&sections, DVec3::Z, [22, 2, 3], 0.1);
        for at in 0..4 {
            self.soften(first, Kind::Belly(at));
        }
        for at in 0..6 {
            let size = if at < 5 { 1.0 } else { 0.7 };
            let spike = [0.0, 0.045 * size, -0.08 * size];
            let [inside, beyond] = [DVec3::new(0.0, 0.01, -0.06), DVec3::from(spike)];
            self.shoot(&[Kind::Crest(at)], [inside, beyond], &[[0.02 * size, 0.03 * size]], [6, 1]);
        }
    }

    /// Moves part of the weight of nearby vertices, from index `first` on, to a bone near the surface.
    fn soften(&mut self, first: usize, kind: Kind) {
        let (bone, center) = (self.bone(kind), self.position(kind));
        let surface = &mut self.surface;
        for (position, influences) in surface.positions[first..].iter().zip(&mut surface.influences[first..])
        {
            let near = (1.0 - position.distance(center) / 0.12).max(0.0);
            let fraction = (0.8 * near * near * (3.0 - 2.0 * near)) as f32;
            influences.iter_mut().for_each(|influence| influence.weight *= 1.0 - fraction);
            influences.push(Influence { bone, weight: fraction });
        }
    }

    fn head(&mut self) {
        let head = |y: f64, z: f64, x: f64, deep: f64| self.section(Kind::Head, [0.0, y, z], [x, deep]);
        let skull = [
            head(-0.01, 0.01, 0.05, 0.058),
            head(0.04, 0.018, 0.075, 0.088),
            head(0.09, 0.014, 0.084, 0.095),
            head(0.14, 0.004, 0.066, 0.074),
        ];
        let muzzle = [
            self.section(Kind::Head, [0.0, 0.035, 0.06], [0.05, 0.035]),
            self.section(Kind::Head, [0.0, 0.028, 0.11], [0.042, 0.028]),
            self.section(Kind::Head, [0.0, 0.022, 0.155], [0.03, 0.02]),
        ];
        let jaw = [
            self.section(Kind::Head, [0.0, -0.008, 0.03], [0.044, 0.018]),
            self.section(Kind::Jaw, [0.0, 0.002, 0.02], [0.04, 0.016]),
            self.section(Kind::Jaw, [0.0, 0.0, 0.085], [0.024, 0.012]),
        ];
        self.tube(&skull, DVec3::Z, [18, 2, 3], 0.02);
        self.tube(&muzzle, DVec3::Y, [10, 2, 3], 0.02);
        self.tube(&jaw, DVec3::Y, [10, 2, 2], 0.03);
        let tongue: Vec<_> = (0..4).map(Kind::Tongue).collect();
        let ends = [DVec3::new(0.0, 0.0, 0.01), DVec3::new(0.0, 0.0, 0.015)];
        self.shoot(&tongue, ends, &[[0.016, 0.006]; 4], [6, 1]);
        for side in [Side::Left, Side::Right] {
            let x = side.sign();
            let eye = [[0.0, 0.0, -0.006], [0.0, 0.0, 0.006]]
                .map(|offset| self.section(Kind::Eye(side), offset, [0.02, 0.02]));
            self.tube(&eye, DVec3::Y, [8, 1, 3], 0.01);
            let ear: Vec<_> = (0..3).map(|at| Kind::Ear(side, at)).collect();
            let ends = [DVec3::new(0.025 * x, 0.035, 0.0), DVec3::new(0.02 * x, 0.05, -0.012)];
            self.shoot(&ear, ends, &[[0.014, 0.03], [0.012, 0.032], [0.008, 0.02]], [8, 2]);
            let feeler: Vec<_> = (0..4).map(|at| Kind::Feeler(side, at)).collect();
            let ends = [DVec3::new(0.01 * x, 0.03, 0.025), DVec3::new(0.012 * x, 0.035, 0.03)];
            self.shoot(&feeler, ends, &[[0.008; 2], [0.006; 2], [0.005; 2], [0.009; 2]], [6, 1]);
        }
    }

    fn arm(&mut self, side: Side) {
        let x = side.sign();
        let sections = [
            self.section(Kind::Clavicle(side), [0.03 * x, -0.02, -0.015], [0.06, 0.06]),
            self.section(Kind::Clavicle(side), [0.1 * x, -0.005, -0.018], [0.062, 0.062]),
            self.section(Kind::UpperArm(side), [0.01 * x, -0.02, 0.0], [0.056, 0.06]),
            self.section(Kind::UpperArmTwist(side), [0.0; 3], [0.043, 0.047]),
            self.section(Kind::Forearm(side), [0.0; 3], [0.036, 0.04]),
            self.section(Kind::ForearmTwist(side), [0.0; 3], [0.034, 0.038]),
            self.section(Kind::Hand(side), [0.0; 3], [0.021, 0.029]),
        ];
        self.tube(&sections, DVec3::Z, [12, 3, 3], 0.09);
        let along = (self.position(Kind::Hand(side)) - self.position(Kind::Forearm(side))).normalize();
        let palm = [
            self.section(Kind::Forearm(side), (along * 0.25).to_array(), [0.018, 0.026]),
            self.section(Kind::Hand(side), (along * 0.015).to_array(), [0.019, 0.04]),
            self.section(Kind::Hand(side), (along * 0.035).to_array(), [0.016, 0.044]),
        ];
        self.tube(&palm, DVec3::Z, [10, 2, 2], 0.03);
        for digit in 0..5 {
            let kinds: Vec<_> = (0..4).map(|at| Kind::Finger(side, digit, at)).collect();
            let size = if digit == 0 { 1.15 } else { 1.0 };
            let radii = [0.0105, 0.0095, 0.0088, 0.0078].map(|radius| [radius * size; 2]);
            self.shoot(&kinds, [along * 0.02, along * 0.022], &radii, [5, 1]);
        }
    }

    fn leg(&mut self, side: Side) {
        let sections = [
            self.section(Kind::Pelvis, [0.075 * side.sign(), 0.0, 0.0], [0.09, 0.1]),
            self.section(Kind::Thigh(side), [0.0, -0.06, 0.0], [0.083, 0.092]),
            self.section(Kind::ThighTwist(side), [0.0; 3], [0.068, 0.078]),
            self.section(Kind::Shin(side), [0.0, 0.01, 0.0], [0.05, 0.058]),
            self.section(Kind::ShinTwist(side), [0.0, 0.06, -0.012], [0.046, 0.056]),
            self.section(Kind::Foot(side), [0.0, 0.03, -0.005], [0.03, 0.036]),
            self.section(Kind::Foot(side), [0.0, -0.03, -0.01], [0.034, 0.042]),
        ];
        self.tube(&sections, DVec3::Z, [13, 3, 3], 0.1);
        let foot = [
            self.section(Kind::Foot(side), [0.0, -0.045, -0.03], [0.034, 0.03]),
            self.section(Kind::Foot(side), [0.0, -0.035, 0.03], [0.04, 0.036]),
            self.section(Kind::Foot(side), [0.0, -0.05, 0.095], [0.046, 0.022]),
            self.section(Kind::Foot(side), [0.0, -0.058, 0.13], [0.044, 0.014]),
        ];
        self.tube(&foot, DVec3::Y, [10, 2, 2], 0.03);
        for digit in 0..5 {
            let kinds: Vec<_> = (0..3).map(|at| Kind::Toe(side, digit, at)).collect();
            let ends = [DVec3::new(0.0, 0.0, 0.015), DVec3::new(0.0, -0.002, 0.015)];
            self.shoot(&kinds, ends, &[[0.0105; 2], [0.01; 2], [0.009; 2]], [5, 1]);
        }
    }

    fn tail(&mut self) {
        let mut sections = vec![self.section(Kind::Pelvis, [0.0, 0.0, -0.05], [0.075, 0.07])];
        sections.extend((0..18).map(|at| {
            let radius = 0.062 - 0.0029 * f64::from(at as u32);
            self.section(Kind::Tail(at), [0.0; 3], [radius; 2])
        }));
        let tip = self.position(Kind::Tail(17)) - self.position(Kind::Tail(16));
        sections.push(self.section(Kind::Tail(17), tip.to_array(), [0.007; 2]));
        self.tube(&sections, DVec3::Y, [12, 1, 3], 0.07);
    }
}

/// Converts a surface to a mesh: adds tangents, and normals that are equal on both sides of texture seams.
fn mesh(surface: Surface, bones: usize) -> Result<Mesh, InputError> {
    let positions: Vec<[f32; 3]> =
        surface.positions.iter().map(|position| position.to_array().map(|x| x as f32)).collect();
    let uv: Vec<[f32; 2]> = surface.uv.iter().map(|uv| uv.map(|x| x as f32)).collect();
    let normals = welded_normals(&positions, &surface.indices);
    let tangents = solved_tangents(&positions, &normals, &uv, &surface.indices)?;
    Ok(Mesh {
        name: "body".to_owned(),
        normals,
        tangents,
        uv,
        influences: Influences::new("body.weights", bones, surface.influences.into_iter().map(strongest))?,
        positions,
        indices: surface.indices,
        ..Mesh::default()
    })
}

/// Merges influences of the same bone and keeps the strongest ones, at most `MAX`.
fn strongest(mut influences: Vec<Influence>) -> Vec<Influence> {
    let mut merged: Vec<Influence> = Vec::new();
    for influence in influences.drain(..).filter(|influence| influence.weight > 1e-3) {
        match merged.iter_mut().find(|known| known.bone == influence.bone) {
            Some(known) => known.weight += influence.weight,
            None => merged.push(influence),
        }
    }
    merged.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    merged.truncate(MAX);
    merged
}

/// Smooth normals; vertices at the same position get the same normal.
fn welded_normals(positions: &[[f32; 3]], indices: &[u32]) -> Vec<[f32; 3]> {
    let welded = weld(positions);
    let indices: Vec<u32> = indices.iter().map(|index| welded[*index as usize]).collect();
    let normals = relievo::asset::mesh::smooth_normals(positions, &indices);
    welded.iter().map(|first| normals[*first as usize]).collect()
}

/// Index of the first vertex at the same position, for each vertex.
pub fn weld(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut first = HashMap::new();
    let bits = |position: &[f32; 3]| position.map(|x| (x + 0.0).to_bits());
    (0..).zip(positions).map(|(at, position)| *first.entry(bits(position)).or_insert(at)).collect()
}
