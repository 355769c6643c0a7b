//! The publications that the dissertation's tables 3.2 (design) and 3.4 (validation) classify, and our own rows beside them: which
//! models belong to each. What a row says is read from its models' cards.

/// A row of the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Paper {
    /// The publication as the tables name it; `ours:` before rows that are not theirs.
    pub name: &'static str,
    /// Its models; the first one's card says what the row says.
    pub models: &'static [&'static str],
    /// Whether the table of design has this row.
    pub design: bool,
    /// Whether the table of validation has this row.
    pub validation: bool,
    /// What a reader should know of the row.
    pub note: &'static str,
}

/// A row of both tables.
const fn both(name: &'static str, models: &'static [&'static str], note: &'static str) -> Paper {
    Paper { name, models, design: true, validation: true, note }
}

/// A row of the table of validation alone.
const fn validation(name: &'static str, models: &'static [&'static str], note: &'static str) -> Paper {
    Paper { name, models, design: false, validation: true, note }
}

/// The rows, those of the dissertation first. A model that is in no row of a table has one of its own at its end.
pub const PAPERS: &[Paper] = &[
    both("Viscido et al. 2002 (SNN/HA/LCH)", &["viscido_snn", "viscido_ha", "viscido_lch"], ""),
    validation(
        "Warburton and Lazarus 1991",
        &["warburton_lazarus_1991"],
        "only in Table 3.4; no control-law in the source",
    ),
    both("Conradt et al. 2009", &["conradt_2009"], "text of the source calls it a discrete-time model"),
    validation("Codling et al. 2007", &["codling_2007"], "only in Table 3.4; no control-law in the source"),
    both("Gueron et al. 1996", &["gueron_1996"], "law uses the own heading although orientation is unmarked"),
    both("Couzin et al. 2005", &["couzin_2005"], ""),
    both("Lopez et al. 2012", &["lopez_2012"], "law uses neighbour headings although orientation is unmarked"),
    validation("Huth and Wissel 1992", &["huth_wissel_a", "huth_wissel_d"], "only in Table 3.4"),
    both("Hamilton 1971", &["hamilton_1d", "hamilton_2d"], ""),
    both("Vicsek et al. 1995", &["vicsek_1995"], ""),
    both("Dong 2012", &["dong_2012"], ""),
    both("Smith and Martin 2009", &["smith_martin_2009"], ""),
    both("Shimoyama et al. 1996", &["shimoyama_1996"], ""),
    both("Czirok et al. 1997", &["czirok_1997"], ""),
    both("Szabo et al. 2008", &["szabo_2008"], ""),
    both("Szabo et al. 2009", &["szabo_2008"], ""),
    both(
        "Levine et al. 2000",
        &["levine_2000"],
        "law uses neighbour velocity directions although velocity is unmarked",
    ),
    both("Toner and Tu 1998", &["toner_tu_1998"], ""),
    both("Gregoire et al. 2003", &["gregoire_2003_angular", "gregoire_2003_vectorial"], ""),
    both("Camperi et al. 2012", &["camperi_2012"], ""),
    both(
        "Helbing et al. 2005",
        &["helbing_2005"],
        "Table 3.4 row is printed as Helbing et al. 2000; physical agents were human participants",
    ),
    both("Mataric 1993", &["mataric_1993"], ""),
    both("Reynolds 1987", &["reynolds_opensteer", "reynolds_kline", "boids_rule_vectors", "boids_plus"], ""),
    both("Kelly and Keating 1996", &["kelly_keating_1996"], ""),
    both("Turgut et al. 2008", &["turgut_2008"], "law uses neighbour headings; Table 3.2 marks velocity"),
    both("Gokce and Sahin 2009", &["gokce_sahin_2009"], ""),
    both("Tanner et al. 2003a", &["tanner_2003_fixed"], "identification used only in the perception function"),
    both("Tanner et al. 2003b", &["tanner_2003_dynamic"], ""),
    both("Jadbabaie et al. 2002", &["jadbabaie_2002_leaderless", "jadbabaie_2002_leader"], ""),
    both("Gazi and Passino 2005", &["gazi_passino_2005"], ""),
    both(
        "Gazi and Passino 2003",
        &["gazi_passino_2003"],
        "law uses position only although velocity and orientation are marked",
    ),
    both(
        "Olfati-Saber 2006",
        &["olfati_saber_2006"],
        "law uses neighbour velocities; velocity is unmarked in Table 3.2",
    ),
    both("Arkin and Balch 1999", &["arkin_balch_1999"], ""),
    both("Fine and Shell 2011", &["ha_extended"], ""),
    both("Hauert et al. 2011", &["hauert_2011"], ""),
    both(
        "ours: Fine and Shell 2012 (LCH variations)",
        &["lch_group_pose", "lch_member_pose", "lch_group_bearing", "lch_member_bearing"],
        "ours; bearing variations need bearing only",
    ),
    both(
        "ours: Fine and Shell 2013 (plus models)",
        &["rm_plus", "snn_plus", "boids_plus"],
        "ours; boids_plus: all collisions, velocity and orientation yes",
    ),
    both("ours: Ballerini et al. 2008", &["ballerini_2008"], "ours"),
    both("ours: Niizato and Gunji 2011", &["niizato_gunji_2011"], "ours"),
    both("ours: Couzin et al. 2002", &["couzin_2002"], "ours"),
    both("ours: Huth and Wissel 1992", &["huth_wissel_a", "huth_wissel_d"], "ours for the Table 3.2 columns"),
    both("ours: Kunz and Hemelrijk 2003", &["kunz_hemelrijk_2003"], "ours"),
    both("ours: Tien et al. 2004", &["tien_2004"], "ours"),
    both("ours: Lukeman et al. 2010", &["lukeman_2010"], "ours"),
    both("ours: Katz 2011 / Herbert-Read 2011", &["katz_herbert_read_2011"], "ours"),
    both("ours: Cucker and Smale 2007", &["cucker_smale_2007"], "ours"),
    both("ours: Warren 2018", &["warren_2018"], "ours; physical agents were human participants"),
    both("ours: Kawabayashi and Chen style five forces", &["boids_five_force"], "ours"),
    both("ours: Hartman and Benes 2006", &["hartman_benes_2006"], "ours"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::{LIST, find};

    /// Columns in which a model differs from the first of its row, which the row's note says.
    const EXCEPTION: (&str, &str) = ("ours: Fine and Shell 2013 (plus models)", "boids_plus");

    #[test]
    fn models_of_one_row_are_classified_alike() {
        for paper in PAPERS {
            let taxonomy = |id: &&str| find(id).map(|entry| entry.card.taxonomy);
            let first = paper.models.first().and_then(taxonomy);
            assert!(first.is_some(), "{} has no model", paper.name);
            for id in paper.models {
                let same = taxonomy(id) == first;
                assert!(same || (paper.name, *id) == EXCEPTION, "{}: {id} is classified otherwise", paper.name);
            }
        }
    }

    #[test]
    fn every_publication_of_the_tables_has_a_model_and_no_model_is_named_twice_in_a_row() {
        let published = |paper: &&Paper| !paper.name.starts_with("ours:");
        assert_eq!(PAPERS.iter().filter(published).filter(|paper| paper.design).count(), 32);
        assert_eq!(PAPERS.iter().filter(published).filter(|paper| paper.validation).count(), 35);
        for paper in PAPERS {
            assert!((1..paper.models.len()).all(|k| !paper.models[..k].contains(&paper.models[k])), "{}", paper.name);
        }
        assert!(LIST.len() > 58);
    }
}
