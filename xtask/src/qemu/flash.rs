//! What lies in the flash that a board keeps for weights.

use std::path::{Path, PathBuf};

use crate::elf;
use crate::failure::Failure;
use crate::targets::Toolchain;

/// The flash a program reads weights from, as its linker script names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Region {
    start: u32,
    end: u32,
}

impl Region {
    /// The region of this program; a program may have none.
    pub(super) fn of(program: &Path) -> Result<Option<Self>, Failure> {
        let unreadable =
            |why: String| Failure::usage(format!("cannot read {}: {why}", program.display()));
        let elf = std::fs::read(program).map_err(|error| unreadable(error.to_string()))?;
        let address = |name| elf::address(&elf, name).map_err(|why| unreadable(why.into()));
        let ends = address("_weights_start")?.zip(address("_weights_end")?);
        Ok(ends.map(|(start, end)| Self { start, end }))
    }
}

/// The QEMU device that writes the file there, or that erases it, as flash comes from the factory.
pub(super) fn device(
    region: Option<Region>,
    weights: Option<&Path>,
) -> Result<Option<String>, Failure> {
    let (region, file) = match (region, weights) {
        (None, None) => return Ok(None),
        (None, Some(_)) => {
            return Err(Failure::usage("--weights: this program keeps no flash for weights"));
        }
        (Some(region), None) => (region, erased(region)?),
        (Some(region), Some(file)) => {
            check_size(region, file).map_err(|why| Failure::usage(format!("--weights: {why}")))?;
            (region, file.to_owned())
        }
    };
    // QEMU takes a doubled comma for one that separates no options.
    let file = file.display().to_string().replace(',', ",,");
    Ok(Some(format!("loader,file={file},addr={:#x},force-raw=on", region.start)))
}

fn check_size(region: Region, file: &Path) -> Result<(), String> {
    let shown = file.display();
    let bytes = std::fs::metadata(file).map_err(|error| format!("{shown}: {error}"))?.len();
    let room = u64::from(region.end - region.start);
    if bytes <= room {
        return Ok(());
    }
    Err(format!("{shown} has {bytes} bytes, at most {room} expected"))
}

/// A file of erased flash. QEMU's loader writes a flash chip from a file, but ignores values for it.
fn erased(region: Region) -> Result<PathBuf, Failure> {
    let content = vec![0xff; (region.end - region.start) as usize];
    let file = Toolchain::Rustup.target_dir().join(format!("xtask-erased-{}.bin", content.len()));
    if std::fs::read(&file).is_ok_and(|found| found == content) {
        return Ok(file);
    }
    // Boards may start at the same time: none may see half a file.
    let draft = file.with_extension(std::process::id().to_string());
    std::fs::write(&draft, &content)
        .and_then(|()| std::fs::rename(&draft, &file))
        .map_err(|error| Failure::failed(format!("cannot write {}: {error}", file.display())))?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::root;

    const REGION: Option<Region> = Some(Region { start: 0x3f_0000, end: 0x3f_0010 });

    #[test]
    fn without_weights_the_flash_is_erased() {
        let device = device(REGION, None).expect("nothing to refuse").expect("a device");
        let file = device
            .strip_prefix("loader,file=")
            .and_then(|rest| rest.strip_suffix(",addr=0x3f0000,force-raw=on"))
            .expect("a loader");
        assert_eq!(std::fs::read(file).expect("the file"), [0xff; 16]);
    }

    #[test]
    fn weights_that_are_not_there_or_do_not_fit_or_have_no_place_are_refused() {
        let refusal =
            |region, file: &Path| device(region, Some(file)).expect_err("refused").to_string();
        let large = root().join("Cargo.toml");
        assert!(refusal(REGION, &large).ends_with("bytes, at most 16 expected"));
        assert!(refusal(REGION, Path::new("no/such.blob")).contains("no/such.blob: "));
        assert_eq!(refusal(None, &large), "--weights: this program keeps no flash for weights");
    }
}
