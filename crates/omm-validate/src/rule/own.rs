//! Rules that the specification states without an identifier.

macro_rules! own_ids {
    ($next:ident $($rest:ident)*; $($table:tt)*) => {
        $next! { $($rest)*; $($table)*
            HostBuild01 = "OMM-host_build-01";

            CopySize01 = "OMM-copy_acceleration_structure-01";
            CopyOverlap02 = "OMM-copy_acceleration_structure-02";
            CopyType03 = "OMM-copy_acceleration_structure-03";

            PartlyNan01 = "OMM-triangles_data-01";
        }
    };
}
