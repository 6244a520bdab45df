<story>
<p><emotion name="joy" weight="0.35"/><gesture name="count_two"/>Dvaja bratia sa raz pohádali o koňa.
<emotion name="anger" weight="0.4"/>Bol to najlepší kôň na hrade a každý z nich tvrdil: <gesture name="emphasize"/>je <emphasis level="strong">môj</emphasis>.
Kričali tak hlasno, že <gesture name="point_up" weight="0.8"/>havrany odleteli z veže.</p>

<p><emotion name="neutral"/>Napokon sa dohodli, že budú pretekať a kôň pobeží voľne medzi nimi.
<emotion name="surprise" weight="0.4"/>Dolu pri rieke vyrazili, <prosody rate="105%">rýchlejšie,</prosody> <prosody rate="118%">a rýchlejšie,</prosody> <prosody rate="130%">a ešte rýchlejšie.</prosody>
<break time="300ms"/><emotion name="joy" weight="0.7"/>A v tej <gesture name="explain"/>istej zákrute <break time="250ms"/>spadli obaja do tej istej priekopy.<gesture name="laugh"/></p>

<p><emotion name="joy" weight="0.3"/><look at="horse"/>Kôň prišiel domov <emphasis>sám</emphasis>.
<look at="visitor"/>Zastal na nádvorí, napil sa zo studne a nepustil k sebe nikoho <gesture name="heart" weight="0.7"/>okrem detí.</p>

<p><emotion name="sadness" weight="0.4"/>Sedem dní sa naň bratia pozerali, každý z iného okna.
<break time="300ms"/><prosody rate="88%">Na ôsmy deň sa <gesture name="sigh"/>zahanbili.</prosody></p>

<p><emotion name="joy" weight="0.5"/>Odvtedy vládli spolu, s jedným stolom, jedným kľúčom <point at="sword"/>a jedným mečom.
<look at="horse"/>A koňa dali odliať do bronzu, <gesture name="large"/>ako sa vzpína, bez sedla a bez uzdy, aby už nikdy nikomu nepatril.</p>

<p><look at="visitor"/>Choďte bližšie a dobre sa pozrite: <gesture name="point_near"/>jedno kopyto je celé vyleštené.
Tam sa ho deti dodnes dotýkajú, pre šťastie.
<break time="400ms"/><emotion name="joy" weight="0.8"/>Môžete aj vy; <look at="fireplace"/><prosody rate="92%">ja sa zatiaľ pozriem <gesture name="shrug" weight="0.6"/>inam.</prosody></p>
</story>
