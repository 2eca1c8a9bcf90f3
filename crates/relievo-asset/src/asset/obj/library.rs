//! Reads material libraries (MTL).

use super::maps::Map;
use super::statements::{Statement, Statements};
use crate::InputError;

/// A material as an MTL library states it, before conversion.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Entry {
    /// Folder of the library. Paths of images are relative to it.
    pub folder: std::path::PathBuf,
    pub name: String,
    /// Diffuse colour (`Kd`), encoded as sRGB.
    pub color: [f64; 3],
    /// Opacity: `d`, or 1 − `Tr`.
    pub opacity: f64,
    /// Emitted colour (`Ke`), encoded as sRGB.
    pub emissive: [f64; 3],
    /// Metalness (`Pm`) and roughness (`Pr`).
    pub metallic: f64,
    pub roughness: f64,
    /// Colour map (`map_Kd`).
    pub color_map: Option<Map>,
    /// Opacity map (`map_d`).
    pub opacity_map: Option<Map>,
    /// Normal map (`norm`).
    pub normal_map: Option<Map>,
    /// Bump map (`map_Bump` or `bump`).
    pub bump_map: Option<Map>,
}

/// Reads the materials of a library, in the order of the file. `file` is the library's path relative to the model.
///
/// # Errors
/// [`InputError`] with the library's name and the line.
pub(super) fn entries(file: &str, bytes: &[u8]) -> Result<Vec<Entry>, InputError> {
    let folder = std::path::Path::new(file).parent().unwrap_or(std::path::Path::new(""));
    let mut entries: Vec<Entry> = Vec::new();
    for statement in Statements::new(bytes) {
        if statement.keyword() == "newmtl" {
            let (folder, name) = (folder.to_owned(), statement.rest().to_owned());
            let (color, opacity, roughness) = ([1.0; 3], 1.0, 1.0);
            entries.push(Entry { folder, name, color, opacity, roughness, ..Entry::default() });
        } else if let Some(entry) = entries.last_mut() {
            entry.read(&statement, file)?;
        }
    }
    Ok(entries)
}

impl Entry {
    fn read(&mut self, statement: &Statement<'_>, file: &str) -> Result<(), InputError> {
        let map = || Map::new(statement, file).map(Some);
        let one = || Ok::<_, InputError>(fractions::<1>(statement, file)?[0]);
        match statement.keyword() {
            "Kd" => self.color = fractions(statement, file)?,
            "Ke" => self.emissive = fractions(statement, file)?,
            "Pm" => self.metallic = one()?,
            "Pr" => self.roughness = one()?,
            "d" => self.opacity = one()?,
            "Tr" => self.opacity = 1.0 - one()?,
            "map_Kd" => self.color_map = map()?,
            "map_d" => self.opacity_map = map()?,
            "norm" => self.normal_map = map()?,
            "map_Bump" | "map_bump" | "bump" => self.bump_map = map()?,
            _ => {}
        }
        Ok(())
    }
}

/// Reads `N` numbers of a statement, each from 0 to 1. A single number stands for all `N`.
fn fractions<const N: usize>(statement: &Statement<'_>, file: &str) -> Result<[f64; N], InputError> {
    let numbers: Option<Vec<f64>> = (statement.words().filter(|word| *word != "-halo"))
        .take(N)
        .map(|word| word.parse().ok().filter(|number| (0.0..=1.0).contains(number)))
        .collect();
    let all = match numbers.as_deref() {
        Some([one]) => Some([*one; N]),
        Some(all) => all.try_into().ok(),
        None => None,
    };
    let bound = || format!("must have {N} number{} from 0 to 1", if N == 1 { "" } else { "s" });
    all.ok_or_else(|| statement.refused(Some(file), bound()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_belong_to_the_material_before_them() {
        let text = "Kd 5 5 5\nnewmtl Old oak\nKd 0.5 0.25 1 # brown\nNs 10\nTr 0.25\nmap_Kd oak.png\n\
                    newmtl b\nKd 0.5\nd -halo 0.5\nbump b.png\nnorm n.png\nmap_d d.png\n";
        let found = entries("lib/a.mtl", text.as_bytes()).expect("valid");
        let [oak, other] = &found[..] else { panic!("{} materials", found.len()) };
        assert_eq!((&*oak.name, oak.color, oak.opacity), ("Old oak", [0.5, 0.25, 1.0], 0.75));
        assert_eq!(oak.color_map.as_ref().map(|map| &*map.name), Some("oak.png"));
        assert_eq!(oak.folder, std::path::Path::new("lib"));
        assert_eq!((other.color, other.opacity), ([0.5; 3], 0.5));
        let maps = [&other.color_map, &other.opacity_map, &other.normal_map, &other.bump_map];
        let names = maps.map(|map| map.as_ref().map(|map| &*map.name));
        assert_eq!(names, [None, Some("d.png"), Some("n.png"), Some("b.png")]);
    }

    #[test]
    fn numbers_out_of_range_are_refused() {
        for text in ["Kd 1 2 0", "Kd 1 0", "Kd", "Kd x y z", "Kd NaN NaN NaN", "d -0.5", "Tr", "d inf"] {
            let error = entries("a.mtl", format!("newmtl a\n{text}\n").as_bytes()).expect_err(text);
            assert_eq!((&*error.path, &*error.value), ("a.mtl line 2", text));
        }
    }
}
