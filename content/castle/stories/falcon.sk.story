<story>
<p><emotion name="joy" weight="0.35"/><show piece="falcon" layer="outside" turn="0" cut="0"/>Poďte <gesture name="beckon"/>sem a pozdravte najtichšieho hosťa tohto domu.
Pútnik si ho priniesol až z Alexandrie, <gesture name="small" weight="0.8"/>zašitého v plášti, a prisahal, že je to sokol z našej studne.
<gesture name="shrug" weight="0.6"/><show piece="falcon" turn="30"/>Päťsto rokov nikto nevedel, čo je vnútri, <break time="250ms"/>lebo nikto sa neodvážil plátno rozrezať.</p>

<p><emotion name="joy" weight="0.3"/>Nôž nepotrebujete: <gesture name="explain" weight="0.7"/>podržte pred ním sklo a pozerajte sa.
Najprv zmizne plátno, <show piece="falcon" layer="outside" over="inside" share="0.7" turn="0"/><prosody rate="90%">vrstva za vrstvou, jedna za druhou.</prosody>
<emotion name="surprise" weight="0.5"/>A potom, <break time="400ms"/><show piece="falcon" layer="inside"/>je tam <gesture name="wonder"/><emphasis>vták</emphasis>!
<show piece="falcon" layer="bone" turn="25"/>Krídla má zložené a pazúry zovreté, <prosody volume="soft" rate="88%">akoby len <gesture name="hush" weight="0.6"/>zaspal.</prosody>
<emotion name="joy" weight="0.4"/>Dokonca v ňom ostalo aj jeho posledné jedlo, <show piece="falcon" layer="bone" turn="-20"/><gesture name="small"/>myš.</p>

<p><emotion name="surprise" weight="0.4"/>A teraz sa pozrite na jeho <gesture name="point_near"/>ľavú nohu.
To je <show piece="falcon" layer="xray" turn="20"/><emphasis>zlatý</emphasis> prsteň a sokolovi je priveľký.
<emotion name="sadness" weight="0.4"/>Niekto si ho stiahol z vlastného <gesture name="heart"/>prsta, <break time="250ms"/><prosody rate="86%">skôr než ovinuli posledný obväz.</prosody></p>

<p><emotion name="fear" weight="0.35"/>A <show piece="falcon" layer="outside" turn="-35"/>tá prasklina na maľovanej hlave, <gesture name="sigh"/>nuž, to som bol ja.
Hneď v deň, keď ho priniesli, mi <emphasis>spadol</emphasis>.
Prasklinu som uzavrel <show piece="falcon" layer="metal"/>živicou a <gesture name="small" weight="0.8"/>kolíčkom zo zvonoviny, premaľoval som ju a nepovedal som to <gesture name="shake_head" weight="0.5"/>nikomu.
<break time="300ms"/><emotion name="joy" weight="0.6"/>Navždy by to bolo ostalo mojím tajomstvom, <break time="200ms"/>keby vám neboli dali <show piece="falcon" layer="outside" turn="0"/>to <gesture name="laugh" weight="0.7"/>sklo.</p>
</story>
